// The decoder against bytes that the program wrote (tests/view/frame_encoder_test.cpp keeps them).

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { blocksOf, ByteReader, FrameState, linkFactor, Names, StreamError } from "../.build/stream.js";
import { Track } from "../.build/track.js";

const hex = readFileSync(new URL("golden_stream.hex", import.meta.url), "utf8").replaceAll("\n", "");
const golden = Uint8Array.from(hex.match(/../g) ?? [], (pair) => Number.parseInt(pair, 16));
const about = { run: "", scenario: "", condition: "mine", replication: 0, policies: [], failure: "", predictor: "", incidents: [] };

/** Frames, in the order of the stream, as plain values. */
function decoded() {
  const names = new Names();
  const state = new FrameState(0.1);
  const frames = [];
  const messages = [];
  for (const { kind, begin, end } of blocksOf(golden)) {
    const reader = new ByteReader(golden, begin, end);
    if (kind === 1) names.add(reader, 0.1);
    else if (kind === 4) messages.push(new TextDecoder().decode(golden.subarray(begin, end)));
    else {
      state.apply(kind, reader);
      frames.push(plain(state));
    }
  }
  return { names, frames, messages };
}

function plain(state) {
  const vehicles = [];
  for (let i = 0; i < state.count; ++i)
    vehicles.push([state.slot[i], state.x[i], state.y[i], state.heading[i], state.speed[i], state.dark[i] === 1]);
  const links = state.links.map((layer) =>
    [...layer].sort((a, b) => a - b).map((link) => [Math.floor(link / linkFactor), link % linkFactor]),
  );
  return { time_s: state.time_s, vehicles, signals: [...state.signals], links, ghosts: [...state.ghosts],
           leases: [...state.leases], ways: [...state.ways], knownBlocks: [...state.knownBlocks], marks: [...state.marks] };
}

const hold = { onSignal: true, target: 2, action: 5, amount: 4, policy: 0, reason: 1, beneficiary: 0 };

test("names come back", () => {
  const { names, messages } = decoded();
  assert.deepEqual(names.vehicles, [
    { id: "ambulance <1>", vehicleClass: 2, kind: 4, length_m: 6.5, width_m: 2.2 },
    { id: "händler", vehicleClass: 0, kind: 0, length_m: 5, width_m: 1.8 },
  ]);
  assert.deepEqual(names.texts, ["green_wave", "ahead of the ambulance", "keep clear"]);
  assert.deepEqual(names.ways, [[5, 6, 200, 3], []]);
  assert.deepEqual(messages, ['{"ended":true}']);
});

test("a key frame comes back", () => {
  const [first] = decoded().frames;
  assert.deepEqual(first, {
    time_s: 100.25,
    vehicles: [[0, 1000, 20, 0, 139, false], [1, 40, 6000, 250, 0, true], [7, 5, 5, 64, 3, false]],
    signals: ["GGrr", "", "rg"],
    links: [[[0, 1], [0, 7], [1, 7]], [], [[0, 7]]],
    ghosts: [{ slot: 1, x: 55, y: 6010, sigma_m: 83 * 0.1, age_s: 2.5 }],
    leases: [hold, { onSignal: false, target: 7, action: 0, amount: 105, policy: 0, reason: 2, beneficiary: -1 }],
    ways: [{ slot: 0, way: 0, at: 2 }, { slot: 7, way: 1, at: 0 }],
    knownBlocks: [9, 300],
    marks: [
      { kind: "request", time_s: 100, vehicle: 0, other: 2 },
      { kind: "departure", time_s: 100.25, vehicle: 0, other: -1 },
    ],
  });
});

test("differences come back", () => {
  const [, second, third, key] = decoded().frames;
  assert.deepEqual(second.vehicles, [[0, 1035, 19, 255, 141, true], [3, -12, 300, 128, 50, false], [7, 5, 5, 64, 0, false]]);
  assert.deepEqual(second.signals, ["GGrr", "", "Gg"]);
  assert.deepEqual(second.links, [[[0, 7]], [[0, 3], [3, 7]], [[0, 7]]]);
  assert.deepEqual(second.leases, [hold]);
  assert.deepEqual(second.ways, [{ slot: 0, way: 1, at: 3 }]);
  assert.deepEqual(second.knownBlocks, [300]);
  assert.deepEqual(second.marks, [
    { kind: "grant", time_s: 100.5, vehicle: 0, other: 2 },
    { kind: "collision", time_s: 100.5, vehicle: 7, other: 3 },
  ]);
  assert.deepEqual(third.vehicles, [[0, 1070, 18, 255, 141, true], [3, -30, 300, 128, 50, false], [7, 5, 5, 64, 0, false]]);
  assert.deepEqual(third.marks, []);
  assert.deepEqual(key, third, "a key frame says the same as the differences up to it");
});

test("a track shows any moment, in any order", () => {
  const track = new Track(about, 0.1);
  track.append(golden);
  const at = (time_s) => plain(track.at(time_s).now);
  const [first, second, third] = decoded().frames;
  assert.deepEqual(at(100.7), { ...third, time_s: 100.5, vehicles: second.vehicles, marks: second.marks });
  assert.deepEqual(at(100.25).vehicles, first.vehicles);
  assert.deepEqual(at(0).vehicles, first.vehicles);
  assert.deepEqual(at(999).vehicles, third.vehicles);
  const between = track.at(100.35);
  assert.equal(between.now.time_s, 100.25);
  assert.equal(between.next.time_s, 100.5);
  assert.ok(Math.abs(between.share - 0.4) < 1e-9);
  assert.equal(track.beside(100.5, 1), 100.75);
  assert.equal(track.beside(100.5, -1), 100.25);
});

test("a stream cut short at any byte is refused or ends with a whole frame", () => {
  const whole = decoded().frames.map((frame) => frame.time_s);
  for (let length = 1; length < golden.length; ++length) {
    const track = new Track(about, 0.1);
    let refused = false;
    try {
      track.append(golden.subarray(0, length));
    } catch (error) {
      assert.ok(error instanceof StreamError, `${error}`);
      refused = true;
    }
    if (!track.empty) assert.ok(whole.includes(track.end_s));
    assert.ok(refused || track.empty || track.end_s <= 100.75);
  }
});

test("rubbish is refused, never shown and never endless", () => {
  let seed = 12345;
  const random = () => (seed = (seed * 1103515245 + 12345) & 0x7fffffff) / 0x7fffffff;
  for (let round = 0; round < 2000; ++round) {
    const bytes = golden.slice();
    for (let i = 0; i < 4; ++i) bytes[Math.floor(random() * bytes.length)] = Math.floor(random() * 256);
    try {
      new Track(about, 0.1).append(bytes);
    } catch (error) {
      assert.ok(error instanceof StreamError || error instanceof RangeError, `${error} ${error.stack}`);
    }
  }
});
