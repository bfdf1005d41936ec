// Draws 5,000 vehicles in headless chromium without a GPU and prints frames a second and processor time a frame.
//   npm run frame-rate [VEHICLES]      on a machine with nothing else to do
//   npm run frame-rate -- PAGE.html    the same of a page of `clearway replay --view`, the whole network in view

import { createHash } from "node:crypto";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { deflateSync } from "node:zlib";
import { alike, folder, openPage, pixelsOf, startBrowser } from "./browser.mjs";

const written = process.argv[2]?.endsWith(".html") ? process.argv[2] : undefined;
const vehicles = Number(written === undefined ? (process.argv[2] ?? 5000) : 0);
const frames = 400;
const measured_ms = 15_000;

/** A stream as the program writes it (docs/reference/frames.md): vehicles that drive east, on twelve roads. */
function stream() {
  const bytes = [];
  const number = (value, to) => {
    for (; value >= 128; value = Math.floor(value / 128)) to.push((value % 128) | 128);
    to.push(value);
  };
  const signed = (value, to) => number(value < 0 ? -2 * value - 1 : 2 * value, to);
  const block = (kind, content) => {
    bytes.push(kind);
    number(content.length, bytes);
    for (const byte of content) bytes.push(byte);
  };
  const names = [];
  number(vehicles, names);
  for (let i = 0; i < vehicles; ++i) names.push(i === 0 ? 2 : i % 2, 0, 50, 18, 1, 118);
  number(0, names);
  block(1, names);
  for (let frame = 0; frame < frames; ++frame) {
    const content = [];
    const each = (value) => {
      for (let i = 0; i < vehicles; ++i) signed(value(i), content);
    };
    number(frame * 250, content);
    number(0, content);
    number(frame === 0 ? vehicles : 0, content);
    if (frame === 0) for (let i = 0; i < vehicles; ++i) number(i === 0 ? 0 : 1, content);
    each((i) => (frame === 0 ? (i * 7919) % 20000 : frame === 1 ? 30 : 0));
    each((i) => (frame === 0 ? (i % 12) * 1600 : 0));
    each(() => 0);
    each(() => (frame === 0 ? 120 : 0));
    for (let part = 0; part < 11; ++part) number(0, content);
    block(frame === 0 ? 2 : 3, content);
  }
  return Uint8Array.from(bytes);
}

function drawing() {
  const lanes = [];
  for (let x = 0; x < 20000; x += 500) {
    for (let road = 0; road < 12; ++road) {
      for (const aside of [-32, 0, 32]) lanes.push({ kind: "road", width: 32, shape: [x, road * 1600 + aside, 250, 0, 250, 0] });
      if (road < 11) lanes.push({ kind: "road", width: 32, shape: [x, road * 1600, 0, 1600] });
    }
  }
  return JSON.stringify({ quantum_m: 0.1, origin_m: [0, 0], size: [20000, 17600], lanes, signals: [] });
}

function writePage() {
  const packed = (bytes) => deflateSync(bytes).toString("base64");
  const about = { run: "", scenario: "", condition: "rate", replication: 0, policies: [], failure: "", predictor: "" };
  const run = { about, begin_s: 0, end_s: frames / 4, stream: packed(stream()) };
  const data = { format: 1, drawings: [packed(drawing())], plays: [{ title: "", note: "", drawing: 0, followed: "", runs: [run] }] };
  const script = readFileSync(new URL("../dist/player.js", import.meta.url), "utf8");
  const hash = createHash("sha256").update(script).digest("base64");
  const file = join(folder, "rate.html");
  writeFileSync(
    file,
    `<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'sha256-${hash}'; style-src 'unsafe-inline'; img-src data: blob:"></head><body><div class="clearway-player" data-mode="replay"></div><script type="application/json" class="clearway-plays">${JSON.stringify(data)}</script><script>${script}</script></body></html>`,
  );
  return file;
}

/** Processor time of this process's descendants, ms, by their kind. */
function processorTime() {
  const all = [];
  for (const pid of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const stat = readFileSync(`/proc/${pid}/stat`, "utf8");
      const words = stat.slice(stat.lastIndexOf(")") + 2).split(" ");
      const kind = /--type=([a-z-]+)/.exec(readFileSync(`/proc/${pid}/cmdline`, "utf8"))?.[1] ?? "browser";
      all.push({ pid: Number(pid), parent: Number(words[1]), kind, spent_ms: 10 * (Number(words[11]) + Number(words[12])) });
    } catch {
      // It ended meanwhile.
    }
  }
  const own = new Set([process.pid]);
  for (let before = 0; before !== own.size; ) {
    before = own.size;
    for (const each of all) if (own.has(each.parent)) own.add(each.pid);
  }
  const sums = {};
  for (const each of all) if (own.has(each.pid) && each.pid !== process.pid) sums[each.kind] = (sums[each.kind] ?? 0) + each.spent_ms;
  return sums;
}

const browser = await startBrowser();
const { page, faults } = await openPage(browser, pathToFileURL(written ?? writePage()).href);
const drawn = async () => Number(await page.locator(".play").getAttribute("data-drawn"));
await page.getByLabel("Speed").selectOption("1");
await page.locator(".map").focus();
await page.keyboard.press("w");
await page.keyboard.press("Space");
// The first frames compile shaders.
for (const begin = await drawn(); (await drawn()) < begin + 30; ) await page.waitForTimeout(200);
const picture = await pixelsOf(page, page.locator(".map"));
let coloured = 0;
for (let y = 0; y < picture.height; ++y) {
  for (let x = 0; x < picture.width; ++x) {
    if ([[214, 154, 0], [32, 110, 235]].some((colour) => alike(picture.at(x, y), colour))) ++coloured;
  }
}
if (faults.length > 0 || coloured < 4 * vehicles)
  throw new Error(`the vehicles are not on the screen: ${coloured} of their pixels; ${faults.join("; ")}`);
const before = processorTime();
const first = await drawn();
const begin_ms = performance.now();
await page.waitForTimeout(measured_ms);
const count = (await drawn()) - first;
const passed_s = (performance.now() - begin_ms) / 1000;
const after = processorTime();
console.log(`${written ?? `${vehicles} vehicles`}: ${(count / passed_s).toFixed(1)} frames a second`);
for (const [kind, spent_ms] of Object.entries(after))
  console.log(`  ${kind}: ${((spent_ms - (before[kind] ?? 0)) / count).toFixed(1)} ms of processor time a frame`);
await browser.close();
