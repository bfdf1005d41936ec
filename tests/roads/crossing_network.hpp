#pragma once

#include <regex>
#include <string>

namespace clearway::roads {

/// A crossing drawn by hand, x to the right, y up; every arm is one-way.
///
///      west (2 lanes, 100 m, 20 m/s)  ->  J  ->  east (2 lanes, 200 m, 10 m/s)  ->  K  ->  back (to start)
///      south (1 lane, 50 m, 10 m/s)   ->  J  ->  east, and north (1 lane, 60 m, 5 m/s)
///
/// Ways through J: west_0 -> east_0 (link 0), west_1 -> east_1 (link 1), south_0 -> east_0 (link 2), and
/// south_0 -> north_0 (link 3), in two pieces of 4 m and 6 m; the others are one piece of 10 m. West may not
/// go north. Signal J has two programs. Lane west_1 is closed to cars but not to emergency vehicles.
inline std::string crossing_network() {
    return R"(<?xml version="1.0" encoding="UTF-8"?>
<net version="1.9">
    <location netOffset="-10.50,20.25" convBoundary="0.00,-60.00,310.00,70.00" origBoundary="0,0,1,1" projParameter="+proj=utm +zone=33"/>
    <edge id=":J_0" function="internal">
        <lane id=":J_0_0" index="0" speed="20.00" length="10.00" shape="100.00,-4.80 110.00,-4.80"/>
        <lane id=":J_0_1" index="1" allow="emergency" speed="20.00" length="10.00" shape="100.00,-1.60 110.00,-1.60"/>
    </edge>
    <edge id=":J_2" function="internal">
        <lane id=":J_2_0" index="0" speed="10.00" length="10.00" shape="105.00,-10.00 110.00,-4.80"/>
    </edge>
    <edge id=":J_3" function="internal">
        <lane id=":J_3_0" index="0" speed="10.00" length="4.00" shape="105.00,-10.00 105.00,-6.00"/>
    </edge>
    <edge id=":J_4" function="internal">
        <lane id=":J_4_0" index="0" speed="10.00" length="6.00" shape="105.00,-6.00 105.00,0.00"/>
    </edge>
    <edge id="west" from="W" to="J" name="High &amp; Low Street" priority="3" type="primary">
        <lane id="west_0" index="0" disallow="pedestrian tram" speed="20.00" length="100.00" shape="0.00,-4.80 100.00,-4.80"/>
        <lane id="west_1" index="1" allow="bus emergency" speed="20.00" length="100.00" width="3.50" shape="0.00,-1.60 100.00,-1.60"/>
    </edge>
    <edge id="east" from="J" to="K" priority="-1">
        <lane id="east_0" index="0" speed="10.00" length="200.00" shape="110.00,-4.80 310.00,-4.80"/>
        <lane id="east_1" index="1" speed="10.00" length="200.00" shape="110.00,-1.60 310.00,-1.60"/>
    </edge>
    <edge id="south" from="S" to="J">
        <lane id="south_0" index="0" speed="10.00" length="50.00" shape="105.00,-60.00 105.00,-10.00"/>
    </edge>
    <edge id="north" from="J" to="N">
        <lane id="north_0" index="0" speed="5.00" length="60.00" shape="105.00,0.00 105.00,20.00 145.00,20.00"/>
    </edge>
    <edge id="back" from="K" to="W">
        <lane id="back_0" index="0" speed="10.00" length="300.00" shape="310.00,60.00 0.00,60.00"/>
    </edge>
    <edge id="path" from="N" to="S">
        <lane id="path_0" index="0" allow="pedestrian" speed="2.00" length="80.00" shape="105.00,20.00 105.00,-60.00"/>
    </edge>
    <tlLogic id="J" type="static" programID="0" offset="0">
        <phase duration="40" state="GGrr"/>
        <phase duration="5" state="yyrr"/>
    </tlLogic>
    <tlLogic id="J" type="static" programID="night" offset="0">
        <phase duration="31" state="GGgr"/>
        <phase duration="9.5" state="rrGG"/>
    </tlLogic>
    <junction id="J" type="traffic_light" x="105" y="-5" incLanes="west_0 west_1 south_0" intLanes=":J_0_0 :J_0_1 :J_2_0 :J_4_0" shape="100,-10 110,0">
        <request index="0" response="0000" foes="1100" cont="0"/>
        <request index="1" response="0000" foes="1000" cont="0"/>
        <request index="2" response="0001" foes="0001" cont="0"/>
        <request index="3" response="0011" foes="0011" cont="1"/>
    </junction>
    <connection from="south" to="east" fromLane="0" toLane="0" via=":J_2_0" tl="J" linkIndex="2" dir="r" state="o"/>
    <connection from="south" to="north" fromLane="0" toLane="0" via=":J_3_0" tl="J" linkIndex="3" dir="s" state="o"/>
    <connection from="west" to="east" fromLane="0" toLane="0" via=":J_0_0" tl="J" linkIndex="0" dir="s" state="O"/>
    <connection from="west" to="east" fromLane="1" toLane="1" via=":J_0_1" tl="J" linkIndex="1" dir="s" state="O"/>
    <connection from="east" to="back" fromLane="1" toLane="0" dir="t" state="M"/>
    <connection from="back" to="west" fromLane="0" toLane="0" dir="t" state="M"/>
    <connection from="back" to="west" fromLane="0" toLane="1" dir="t" state="M"/>
    <connection from=":J_0" to="east" fromLane="0" toLane="0" dir="s" state="M"/>
    <connection from=":J_0" to="east" fromLane="1" toLane="1" dir="s" state="M"/>
    <connection from=":J_2" to="east" fromLane="0" toLane="0" dir="r" state="M"/>
    <connection from=":J_3" to="north" fromLane="0" toLane="0" via=":J_4_0" dir="s" state="m"/>
    <connection from=":J_4" to="north" fromLane="0" toLane="0" dir="s" state="M"/>
</net>
)";
}

/// The same crossing without its signal: south yields to west.
inline std::string crossing_without_signal() {
    const std::string without_links =
        std::regex_replace(crossing_network(), std::regex(R"( tl="J" linkIndex="\d")"), "");
    return std::regex_replace(without_links, std::regex(R"(type="traffic_light")"), R"(type="priority")");
}

}  // namespace clearway::roads
