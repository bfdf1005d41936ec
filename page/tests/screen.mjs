// What should be on the screen: places and colours of vehicles and stop lines, read here a second time.

import { readFileSync } from "node:fs";
import { alike } from "./browser.mjs";

export const classColours = { human: [214, 154, 0], automated: [32, 110, 235], emergency: [225, 0, 40] };

/** Lanes, edges by number and signal links of SUMO's network file. */
export function readNetwork(file) {
  const text = readFileSync(file, "utf8");
  const attribute = (tag, name) => new RegExp(` ${name}="([^"]*)"`).exec(tag)?.[1];
  const shapes = new Map();
  let left = Infinity;
  let low = Infinity;
  for (const [tag] of text.matchAll(/<lane [^>]*>/g)) {
    const points = attribute(tag, "shape").split(" ").map((point) => point.split(",").map(Number));
    shapes.set(attribute(tag, "id"), points);
    for (const [x, y] of points) {
      left = Math.min(left, x);
      low = Math.min(low, y);
    }
  }
  const edges = [...text.matchAll(/<edge [^>]*>/g)].map(([tag]) => attribute(tag, "id"));
  const lanes = new Map();
  for (const [tag] of text.matchAll(/<connection [^>]*>/g)) {
    const signal = attribute(tag, "tl");
    if (signal === undefined) continue;
    const lane = `${attribute(tag, "from")}_${attribute(tag, "fromLane")}`;
    const links = lanes.get(lane) ?? { signal, shape: shapes.get(lane), links: new Set() };
    lanes.set(lane, { ...links, links: links.links.add(Number(attribute(tag, "linkIndex"))) });
  }
  const stopLines = [...lanes.values()].map((lane) => ({ ...lane, at: lane.shape.at(-1) }));
  return { origin: [Math.floor(left), Math.floor(low)], stopLines, shapes, edges };
}

/** Where a place of the network, m from its lower left corner, is on the screen. */
export function onScreen(pane, camera, [x, y]) {
  const scale = 2 ** camera.zoom;
  return [pane.left + pane.width / 2 + (x - camera.x) * scale, pane.height / 2 - (y - camera.y) * scale];
}

/** Whether a point of the screen is on the map of a pane, and not below its caption. */
export function isInside(pane, [x, y]) {
  return x > pane.left + 12 && y > 48 && x < pane.left + pane.width - 12 && y < pane.height - 12;
}

export function middleOf(vehicle) {
  const half_m = vehicle.class === "emergency" ? 3 : 2;
  const heading = Number(vehicle.heading_rad);
  return [Number(vehicle.x_m) - half_m * Math.cos(heading), Number(vehicle.y_m) - half_m * Math.sin(heading)];
}

/** Looks up every vehicle of a table in a picture. Returns how many were seen, how often a place beside one had its colour, and what is wrong. */
export function compareVehicles(picture, pane, camera, origin, present) {
  const found = { vehicles: 0, displaced: 0, wrong: [] };
  const middles = present.map(middleOf);
  present.forEach((row, k) => {
    const at = onScreen(pane, camera, [middles[k][0] - origin[0], middles[k][1] - origin[1]]);
    // Where two overlap on the screen, the upper one counts.
    const near = middles.some((other, j) => j !== k && Math.hypot(other[0] - middles[k][0], other[1] - middles[k][1]) < 7);
    if (!isInside(pane, at) || near) return;
    ++found.vehicles;
    const colour = picture.at(...at);
    if (!alike(colour, classColours[row.class])) found.wrong.push(`${row.vehicle} at ${row.time_s} s is ${colour} on the screen`);
    if (alike(picture.at(at[0] + 25, at[1] + 25), classColours[row.class])) ++found.displaced;
  });
  return found;
}
