// How curves are drawn, without a browser.

import assert from "node:assert/strict";
import { test } from "node:test";
import { drawingOrder, rangeOf } from "../.build/curves.js";

const tracks = (...conditions) => conditions.map((condition) => ({ about: { condition } }));

test("the wide line of the baseline is drawn below the other", () => {
  assert.deepEqual(drawingOrder(tracks("baseline", "corridor")), [0, 1]);
  assert.deepEqual(drawingOrder(tracks("corridor", "baseline_sublane")), [1, 0]);
  assert.deepEqual(drawingOrder(tracks("corridor", "navigate")), [0, 1]);
});

test("the axis of a curve begins at 0 and has room above the highest value", () => {
  assert.deepEqual(rangeOf(100), [0, 105]);
  assert.deepEqual(rangeOf(0), [0, 1]);
  assert.deepEqual(rangeOf(null), [0, 1]);
});
