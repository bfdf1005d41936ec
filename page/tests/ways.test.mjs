// Ways of emergency vehicles on a map small enough to draw by hand.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Track } from "../.build/track.js";
import { changeText, consideredLines, consideredText, formerLines, lengthOf, lineAhead, middleOf, reasonOf, WayLog } from "../.build/ways.js";

/** Edge 0 leads east for 100 m, 1 on for 100 m with a footway and two lanes, 2 north for 50 m from where 1 begins, 3 north from its end. */
const lane = (...path) => ({ kind: path[1] === -4 ? "walk" : "road", width_m: 3.2, path: Float32Array.from(path) });
const drawing = {
  quantum_m: 0.1, size_m: [200, 100], signals: [],
  lanes: [lane(0, 0, 100, 0), lane(100, -4, 200, -4), lane(100, 0, 200, 0), lane(100, 4, 200, 4), lane(100, 0, 100, 50), lane(200, 0, 200, 100)],
  edges: [[0, 1], [1, 3], [4, 1], [5, 1]],
};
const about = { run: "", scenario: "", condition: "mine", replication: 0, policies: [], failure: "", predictor: "", incidents: [] };
const hex = readFileSync(new URL("golden_stream.hex", import.meta.url), "utf8").replaceAll("\n", "");
const golden = Uint8Array.from(hex.match(/../g) ?? [], (pair) => Number.parseInt(pair, 16));
const played = (incidents) => {
  const track = new Track({ ...about, incidents }, 0.1);
  track.append(golden);
  return track;
};

test("the middle of an edge lies between its outer lanes", () => {
  assert.deepEqual(middleOf(drawing, 1), [[100, 2], [200, 2]]);
  assert.deepEqual(middleOf(drawing, 99), []);
});

test("the way ahead begins at the vehicle", () => {
  assert.deepEqual(lineAhead(drawing, [0, 1, 3], 0, [40, 1]), [[40, 1], [100, 0], [100, 2], [200, 2], [200, 0], [200, 100]]);
  assert.deepEqual(lineAhead(drawing, [0, 1, 3], 2, [200, 70]), [[200, 70], [200, 100]]);
  assert.deepEqual(lineAhead(drawing, [], 0, [1, 1]), []);
});

test("of a former way only what is not taken any more is shown, joined to the present one", () => {
  assert.deepEqual(formerLines(drawing, [0, 1, 3], [0, 2, 3], 0), [[[100, 0], [100, 2], [200, 2], [200, 0]]]);
  assert.deepEqual(formerLines(drawing, [0, 1, 3], [0, 1, 3], 0), []);
  assert.deepEqual(formerLines(drawing, [0, 1, 3], [0, 2], 2), [[[200, 2], [200, 0], [200, 100]]], "what was driven is no matter");
  assert.equal(lengthOf([[0, 0], [3, 4], [3, 5]]), 6);
});

test("a change is another way of a vehicle that had one", () => {
  const log = new WayLog();
  assert.deepEqual(log.take(1, [{ slot: 4, way: 0, at: 0 }]), []);
  assert.deepEqual(log.take(2, [{ slot: 4, way: 0, at: 1 }, { slot: 6, way: 1, at: 0 }]), []);
  assert.deepEqual(log.take(3, [{ slot: 4, way: 2, at: 1 }]), [{ slot: 4, time_s: 3, before: 0, after: 2, at: 1 }]);
  assert.equal(log.shown(4, 2.9), undefined);
  assert.equal(log.shown(4, 32)?.after, 2);
  assert.equal(log.shown(4, 33), undefined);
  assert.equal(log.shown(6, 5), undefined);
});

test("a track marks a change and tells its reason", () => {
  const track = played([]);
  assert.deepEqual(track.ways.all, [{ slot: 0, time_s: 100.5, before: 0, after: 1, at: 3 }]);
  assert.deepEqual(track.marks.filter(({ kind }) => kind === "way"), [{ kind: "way", time_s: 100.5, vehicle: 0, other: -1 }]);
  const [change] = track.ways.all;
  assert.equal(reasonOf(change, track), "no policy asked for it");
  const block = { edge: 3, lanes: [4], place: [0, 0], from_s: 90, to_s: 200 };
  assert.equal(reasonOf(change, played([block])), "the road ahead was blocked (its crew, no policy)");
  assert.equal(reasonOf(change, played([{ ...block, to_s: 100 }])), "no policy asked for it");
  assert.equal(reasonOf(change, played([{ ...block, edge: 5 }])), "no policy asked for it", "it was past that road");
  const lease = { onSignal: false, target: 0, action: 9, amount: 0, policy: 0, reason: 2, beneficiary: 0 };
  track.asked.all.push({ lease, from_s: 100, to_s: 100.25 });
  assert.equal(reasonOf(change, track), "keep clear (green_wave)");
  assert.equal(changeText(change, track, drawing), "100.50 s: took another way, 0 m ahead instead of 100 m: keep clear (green_wave)");
});

const considered = (way, more = {}) => ({ onSignal: false, target: 0, action: 8, amount: way + 1, policy: 0, reason: 2, beneficiary: 0, ...more });

test("of a way that was considered only what the present one does not take is drawn", () => {
  const ways = [[0, 1, 3], [0, 2, 3], [5, 0, 1, 3], [5, 0, 2, 3]];
  const lines = (leases, way, at) => consideredLines(drawing, leases, { slot: 0, way, at }, ways);
  const aside = [[100, 0], [100, 0], [100, 50], [200, 0]];
  assert.deepEqual(lines([considered(1)], 0, 0), [aside]);
  assert.deepEqual(lines([considered(1)], 2, 1), [aside], "what was driven before is no matter");
  assert.deepEqual(lines([considered(3)], 2, 1), [aside], "of neither way");
  assert.deepEqual(lines([considered(0)], 0, 0), [], "it is the present one");
  const others = [considered(1, { target: 4 }), considered(1, { onSignal: true }), considered(1, { action: 9 }), considered(-1), considered(7)];
  assert.deepEqual(lines(others, 0, 0), []);
});

test("a way that was considered is told with both lengths and its reason, each way once", () => {
  const track = played([]);
  // Of the present way, 5 6 200 3, the map has the last edge alone; 48 m lie between the ends of 2 and 1.
  const [first, second] = [track.names.ways.push([6, 2]) - 1, track.names.ways.push([5, 2, 1]) - 1];
  const words = (lease) => consideredText(lease, 99, track, drawing);
  assert.equal(words(considered(first)), "considered another way, 50 m ahead instead of 100 m: keep clear (green_wave)");
  assert.match(words(considered(second)), /, 198 m ahead instead of 100 m: /);
  assert.equal(words(considered(first, { action: 9 })), undefined);
  assert.equal(words(considered(-1)), undefined, "a policy that stands back from no way");
  const log = new Track(about, 0.1).asked;
  [first, first, second].forEach((way, i) => log.take(i, [considered(way)]));
  assert.deepEqual(log.all.map(({ lease, from_s, to_s }) => [lease.amount - 1, from_s, to_s]), [[first, 0, 1], [second, 2, 2]]);
});

test("the way at a moment is the one before the next change", () => {
  const log = new WayLog();
  log.take(1, [{ slot: 4, way: 0, at: 0 }]);
  log.take(2, [{ slot: 4, way: 2, at: 0 }]);
  log.take(3, [{ slot: 4, way: 5, at: 0 }]);
  assert.deepEqual([1, 2, 2.5, 3, 9].map((time_s) => log.at(4, time_s)), [0, 2, 2, 5, 5]);
  assert.equal(log.at(7, 2), undefined);
});

test("a block counts while it lasts", () => {
  const track = played([{ edge: 3, lanes: [4], place: [0, 0], from_s: 90, to_s: 200 }]);
  assert.deepEqual([89, 90, 199.9, 200].map((time_s) => track.blocksAt(time_s).length), [0, 1, 1, 0]);
});
