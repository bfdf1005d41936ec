// Runs that happen now, in a real browser: in step, as they are recorded, and only for who may control them.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { after, before, test } from "node:test";
import { clearway, folder, grouped, keepPicture, openPage, patience_ms, pixelsOf, rows, settled, startBrowser } from "./browser.mjs";
import { compareVehicles, readNetwork } from "./screen.mjs";

const options = { timeout: 4 * patience_ms };
const conditions = ["baseline", "corridor"];
let browser;
let snapshots;

before(async () => {
  clearway("run", "intersection", "--seeds", "1", "--no-solo", "--record", "--out", "runs/usual");
  snapshots = conditions.map((condition) => {
    const table = clearway("replay", `runs/usual/intersection/${condition}/0`, "--csv", "snapshot");
    return new Map([...grouped(rows(table), "time_s")].map(([time_s, vehicles]) => [Number(time_s), vehicles]));
  });
  browser = await startBrowser();
}, options);
const programs = [];
after(() => {
  // A test that failed has left its program.
  for (const program of programs) program.kill("SIGKILL");
  return browser?.close();
});

/** Starts `clearway live` and waits until it serves. */
async function serve(out, ...words) {
  const program = spawn(process.env.CLEARWAY ?? "clearway", ["live", "intersection", "--port", "0", "--out", out, ...words], {
    cwd: folder, stdio: ["ignore", "pipe", "ignore"],
  });
  programs.push(program);
  const ended = once(program, "exit");
  const [address] = await once(createInterface(program.stdout), "line");
  return { address, program, ended };
}

/** A number of a stream (docs/reference/frames.md) and where it ends. */
function numberAt(bytes, at) {
  let value = 0;
  let factor = 1;
  for (; bytes[at] >= 128; factor *= 128) value += factor * (bytes[at++] & 127);
  return [value + factor * bytes[at], at + 1];
}

/** Opens the page of a live run and keeps what the server says: frames, and how far each run has come. */
async function watch(address, choices = {}) {
  const heard = { frames: 0, reached_s: [0, 0], status: undefined };
  const take = (bytes) => {
    const isFrame = bytes[1] === 2 || bytes[1] === 3;
    if (!isFrame) return;
    ++heard.frames;
    heard.reached_s[bytes[0]] = numberAt(bytes, numberAt(bytes, 2)[1])[0] / 1000;
  };
  const opened = await openPage(browser, address, choices, (page) =>
    page.on("websocket", (socket) =>
      socket.on("framereceived", ({ payload }) => {
        if (typeof payload !== "string") take(payload);
        else heard.status = JSON.parse(payload).status ?? heard.status;
      })));
  return { ...opened, heard };
}

async function until(what, holds) {
  for (const begin_ms = performance.now(); !(await holds()); ) {
    assert.ok(performance.now() - begin_ms < patience_ms, what);
    await new Promise((done) => setTimeout(done, 50));
  }
}

/** The runs finish what they were allowed before the server paused. */
async function pausedFor(heard, page) {
  await until("the server pauses", () => heard.status?.paused === true);
  for (let frames = -1; frames !== heard.frames; ) {
    ({ frames } = heard);
    await page.waitForTimeout(1000);
  }
  await settled(page);
  assert.deepEqual(heard.reached_s, Array(2).fill(await timeOf(page)), "both runs have come to the moment that is shown");
}

const timeOf = async (page) => Number(await page.locator(".play").getAttribute("data-time"));

/** Both panes against the recordings of the same runs. Returns how many vehicles were seen. */
async function compare(page, origin) {
  const time_s = await timeOf(page);
  let seen = 0;
  for (const [i, condition] of conditions.entries()) {
    const present = snapshots[i].get(time_s);
    assert.ok(present !== undefined, `${condition} was recorded at ${time_s} s`);
    const near = (one) => present.filter((row) => Math.hypot(row.x_m - one.x_m, row.y_m - one.y_m) < 60).length;
    const vehicle = present.reduce((best, row) => (near(row) > near(best) ? row : best));
    const camera = { x: vehicle.x_m - origin[0], y: vehicle.y_m - origin[1], zoom: 2.2 };
    await page.evaluate(({ x, y, zoom }) => (location.hash = `x=${x}&y=${y}&zoom=${zoom}`), camera);
    await settled(page);
    assert.equal(await timeOf(page), time_s, "looking elsewhere does not move the time");
    const picture = await pixelsOf(page, page.locator(".map"));
    const pane = { left: (i * picture.width) / 2, width: picture.width / 2, height: picture.height };
    const found = compareVehicles(picture, pane, camera, origin, present);
    assert.deepEqual(found.wrong, [], condition);
    seen += found.vehicles;
  }
  return seen;
}

test("who may control pauses, steps and sets the speed, and both runs are in step and as they are recorded", options, async () => {
  const { address, ended } = await serve("runs/live", "--allow-control", "--speed", "2");
  const { page, faults, heard, close } = await watch(address);
  const { origin } = readNetwork(join(folder, "runs/live/scenarios/intersection/network/network.net.xml"));
  for (const name of ["ghosts", "leases", "believed links"]) await page.getByLabel(name).uncheck();
  const button = page.getByRole("button", { name: "Play or pause" });
  let seen = 0;
  let first_s = 0;
  for (const wanted_s of [60, 90, 120]) {
    await page.getByLabel("Speed").selectOption("30");
    await until("the server takes the speed", () => heard.status?.speed === 30);
    await until(`it comes to ${wanted_s} s`, async () => (await timeOf(page)) >= wanted_s);
    await button.click();
    await pausedFor(heard, page);
    const paused_s = await timeOf(page);
    const { frames } = heard;
    seen += await compare(page, origin);
    assert.equal(heard.frames, frames, "nothing goes on");
    await page.getByRole("button", { name: "One frame on" }).click();
    await until("one step is made", async () => (await timeOf(page)) > paused_s);
    await settled(page);
    assert.equal(heard.frames, frames + 2, "one frame of each run");
    assert.equal(await timeOf(page), paused_s + 0.25);
    seen += await compare(page, origin);
    if (first_s === 0) first_s = paused_s;
    await button.click();
    await until("the server goes on", () => heard.status?.paused === false);
  }
  // How late a slow machine stops the runs decides how many are still on the road.
  assert.ok(seen >= 12, `${seen} vehicles were compared`);
  const captions = await page.locator(".caption").allTextContents();
  conditions.forEach((condition, i) => assert.ok(captions[i].startsWith(`${condition}: `), captions[i]));
  await until("the runs end", () => heard.status?.ended === true);
  await page.getByText("what was seen can be played again").waitFor();
  await page.evaluate((time_s) => (location.hash = `time=${time_s}`), first_s);
  await settled(page);
  assert.equal(await timeOf(page), first_s);
  assert.ok((await compare(page, origin)) > 0, "a moment that was seen is shown again");
  assert.deepEqual(await ended, [0, null]);
  for (const table of ["runs.csv", "vehicles.csv"])
    assert.equal(readFileSync(join(folder, "runs/live", table), "utf8"), readFileSync(join(folder, "runs/usual", table), "utf8"));
  assert.deepEqual(faults, []);
  await close();
});

test("who may only watch stops the picture and not the runs", options, async () => {
  const { address, program, ended } = await serve("runs/watched", "--speed", "1");
  const { page, faults, heard, close } = await watch(address);
  assert.equal(await page.getByLabel("Speed").count(), 0);
  await page.getByText("This page only watches").waitFor();
  await page.locator(".map").focus();
  await page.keyboard.press("Space");
  const stopped_s = await timeOf(page);
  const { frames } = heard;
  await until("the runs go on", () => heard.frames > frames + 8);
  assert.equal(heard.status.paused, false);
  assert.equal(await timeOf(page), stopped_s, "the picture stands");
  await page.getByRole("button", { name: "One frame back" }).click();
  assert.ok((await timeOf(page)) < stopped_s);
  await page.getByRole("button", { name: "Play or pause" }).click();
  await until("the newest moment is shown", async () => (await timeOf(page)) > stopped_s + 1);
  program.kill("SIGINT");
  assert.deepEqual(await ended, [130, null]);
  await page.getByText("The server has closed the connection").waitFor();
  assert.deepEqual(faults, []);
  await close();
});

test("the view comes near the emergency vehicle when it enters, but for who has chosen another", options, async () => {
  const { address, program, ended } = await serve("runs/near", "--speed", "1", "--allow-control");
  const [waits, chose] = [await watch(address), await watch(address)];
  const zoomOf = async ({ page }) => Number(await page.locator(".play").getAttribute("data-zoom"));
  const captionOf = ({ page }) => page.locator(".caption").first().textContent();
  await chose.page.getByRole("button", { name: "Farther" }).click();
  const whole = await zoomOf(waits);
  const chosen = await zoomOf(chose);
  assert.ok(whole < 2.2 && chosen < whole, `${whole}, ${chosen}`);
  for (const one of [waits, chose]) {
    assert.match(await captionOf(one), /: no emergency vehicle yet, the run goes on; /);
    assert.doesNotMatch(await captionOf(one), /run over/);
  }
  await waits.page.getByLabel("Speed").selectOption("30");
  for (const one of [waits, chose]) await until("one enters", async () => / km\/h; /.test(await captionOf(one)));
  assert.equal(await zoomOf(waits), 2.2);
  assert.equal(await zoomOf(chose), chosen);
  program.kill("SIGINT");
  assert.deepEqual(await ended, [130, null]);
  for (const { faults, close } of [waits, chose]) {
    assert.deepEqual(faults, []);
    await close();
  }
});

test("the page fits phones, tablets and desks, light and dark, and obeys the keyboard and the wish for less motion", options, async () => {
  const { address, program, ended } = await serve("runs/sizes", "--speed", "2", "--allow-control");
  for (const [width, colorScheme] of [[360, "dark"], [768, "light"], [1440, "dark"]]) {
    const { page, faults, heard, close } = await watch(address, {
      viewport: { width, height: 800 }, colorScheme, reducedMotion: width === 768 ? "reduce" : "no-preference",
    });
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `the page is too wide for ${width} px`);
    await page.locator(".map").focus();
    await page.keyboard.press("Space");
    await pausedFor(heard, page);
    const paused_s = await timeOf(page);
    await page.keyboard.press(".");
    await until("one step is made", async () => (await timeOf(page)) === paused_s + 0.25);
    await keepPicture(page, `live-${width}-${colorScheme}`);
    await page.keyboard.press("Space");
    await until("the server goes on", () => heard.status?.paused === false);
    await until("the picture goes on", async () => (await timeOf(page)) > paused_s + 1);
    assert.deepEqual(faults, []);
    await close();
  }
  program.kill("SIGTERM");
  assert.deepEqual(await ended, [143, null]);
});
