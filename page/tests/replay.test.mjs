// A replay in a real browser: what is on the screen is what was recorded.

import assert from "node:assert/strict";
import { readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { alike, clearway, folder, grouped, keepPicture, openPage, patience_ms, pixelsOf, rows, settled, startBrowser } from "./browser.mjs";
import { compareVehicles, isInside, middleOf, onScreen, readNetwork } from "./screen.mjs";

const options = { timeout: 4 * patience_ms };
const run = "runs/mine/city/corridor/0";
const baseline = "runs/mine/city/baseline/0";
const single = join(folder, "single.html");
const pair = join(folder, "pair.html");
const blocked = join(folder, "blocked.html");
const block = { edge: "-142575655#10", lane: "-142575655#10_1", from_s: 80, known_s: 140, to_s: 320 };
const address = (file) => pathToFileURL(file).href;
let browser;

before(async () => {
  clearway("run", "city", "--seeds", "1", "--no-solo", "--record", "--out", "runs/mine");
  clearway("replay", run, "--view", "--out", single);
  clearway("replay", baseline, run, "--view", "--out", pair);
  clearway("run", "city_v2", "--policy", "navigate", "--seeds", "1", "--no-solo", "--record", "--out", "runs/blocked", "--incident",
    `edge=${block.edge},from_s=${block.from_s},to_s=${block.to_s},known_after_s=${block.known_s - block.from_s},reroute_share=0.5`);
  clearway("replay", "runs/blocked/city_v2/baseline/0", "runs/blocked/city_v2/navigate/0", "--view", "--out", blocked);
  browser = await startBrowser();
}, options);
after(() => browser?.close());

const signalColours = {
  G: [0, 165, 80], g: [130, 200, 60], y: [250, 190, 0], Y: [250, 190, 0], u: [250, 190, 0],
  r: [200, 30, 30], R: [200, 30, 30], s: [200, 30, 30],
};

test("at ten moments vehicles and signals are on the screen where the recording has them", options, async () => {
  const { origin, stopLines } = readNetwork(join(folder, "runs/mine/scenarios/city/network/network.net.xml"));
  const snapshot = grouped(rows(clearway("replay", run, "--csv", "snapshot")), "time_s");
  const signals = grouped(rows(clearway("replay", run, "--csv", "signals")), "time_s");
  const times = [...snapshot.keys()].filter((time) => snapshot.get(time).some((row) => row.class === "emergency"));
  const { page, faults, close } = await openPage(browser, address(single));
  for (const name of ["ghosts", "leases", "believed links"]) await page.getByLabel(name).uncheck();
  const count = { vehicles: 0, displaced: 0, signals: 0, states: new Set() };
  for (let i = 0; i < 10; ++i) {
    const time = times[Math.floor((i * (times.length - 1)) / 9)];
    const present = snapshot.get(time);
    const state = new Map(signals.get(time).map((row) => [row.signal, row.state]));
    const line = stopLines[(i * 37) % stopLines.length].at;
    const near = (one) => present.filter((row) => Math.hypot(row.x_m - one.x_m, row.y_m - one.y_m) < 90).length;
    const vehicle = present.reduce((best, row) => (near(row) > near(best) ? row : best));
    const [x, y] = i % 2 === 0 ? [Number(vehicle.x_m), Number(vehicle.y_m)] : line;
    const camera = { x: x - origin[0], y: y - origin[1], zoom: i % 2 === 0 ? 2 : 2.5 };
    await page.evaluate(({ time_s, camera }) => {
      location.hash = `time=${time_s}&x=${camera.x}&y=${camera.y}&zoom=${camera.zoom}`;
    }, { time_s: time, camera });
    await settled(page);
    assert.equal(Number(await page.locator(".play").getAttribute("data-time")), Number(time));
    const picture = await pixelsOf(page, page.locator(".map"));
    const pane = { left: 0, width: picture.width, height: picture.height };
    const place = ([px, py]) => onScreen(pane, camera, [px - origin[0], py - origin[1]]);
    const seen = compareVehicles(picture, pane, camera, origin, present);
    assert.deepEqual(seen.wrong, []);
    count.vehicles += seen.vehicles;
    count.displaced += seen.displaced;
    const middles = present.map(middleOf);
    for (const { signal, at, shape, links } of stopLines) {
      if (!isInside(pane, place(at)) || middles.some((other) => Math.hypot(other[0] - at[0], other[1] - at[1]) < 8)) continue;
      const [x, y] = shape.at(-2);
      const length = Math.hypot(at[0] - x, at[1] - y);
      const left = [(y - at[1]) / length, (at[0] - x) / length];
      [...links].sort((one, other) => one - other).forEach((link, k) => {
        // Links that begin on one lane share its stop line, from right to left.
        const aside_m = ((k + 0.5) / links.size - 0.5) * 3.2;
        const spot = place([at[0] + left[0] * aside_m, at[1] + left[1] * aside_m]);
        const colour = picture.at(...spot);
        const letter = state.get(signal)[link];
        ++count.signals;
        count.states.add(letter);
        assert.ok(
          // A line is a few pixels wide, and its edge is mixed with what lies below it.
          [-2, -1, 0, 1, 2].some((dx) => [-2, -1, 0, 1, 2].some((dy) =>
            alike(picture.at(spot[0] + dx, spot[1] + dy), signalColours[letter] ?? [128, 128, 128]))),
          `link ${link} of ${signal} at ${time} s shows ${letter} and is ${colour} on the screen`,
        );
      });
    }
  }
  assert.ok(count.vehicles >= 25, `${count.vehicles} vehicles were compared`);
  assert.ok(count.signals >= 40, `${count.signals} stop lines were compared`);
  assert.ok(count.states.has("r") && (count.states.has("G") || count.states.has("g")), [...count.states].join(""));
  assert.ok(count.displaced < count.vehicles / 5, "a place beside a vehicle is not its colour");
  assert.deepEqual(faults, []);
  await close();
});

for (const [width, colorScheme] of [[360, "light"], [360, "dark"], [768, "dark"], [1440, "light"]]) {
  test(`every control works at ${width} px, ${colorScheme}`, options, async () => {
    const { page, faults, close } = await openPage(browser, address(pair), {
      viewport: { width, height: 800 }, colorScheme, reducedMotion: width === 768 ? "reduce" : "no-preference",
    });
    const time = async () => Number(await page.locator(".play").getAttribute("data-time"));
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page is too wide");
    const begin_s = await time();
    await page.getByRole("button", { name: "One frame on" }).click();
    assert.ok(Math.abs((await time()) - begin_s - 0.25) < 1e-6);
    await page.getByRole("button", { name: "One frame back" }).click();
    assert.ok(Math.abs((await time()) - begin_s) < 1e-6);
    await page.getByLabel("Speed").selectOption("30");
    await page.getByRole("button", { name: "Play or pause" }).click();
    await page.waitForFunction((from) => Number(document.querySelector(".play").dataset.time) > from + 2, begin_s);
    await page.getByRole("button", { name: "Play or pause" }).click();
    const paused_s = await time();
    for (const name of ["true links", "observed links", "believed links", "ghosts", "leases", "way"]) {
      const box = page.getByLabel(name, { exact: true });
      await box.setChecked(!(await box.isChecked()));
    }
    for (const name of ["Nearer", "Farther", "The way ahead", "The whole network"]) await page.getByRole("button", { name }).click();
    assert.equal(await page.getByLabel("follow the emergency vehicle").isChecked(), false);
    assert.equal(await time(), paused_s, "only the clock moves the time");
    await page.getByLabel("follow the emergency vehicle").check();
    const captions = await page.locator(".caption").allTextContents();
    assert.match(captions[0], /^baseline: /);
    assert.match(captions[1], /^corridor: /);
    const field = await page.evaluate(() => getComputedStyle(document.querySelector(".caption")).backgroundColor);
    assert.equal(field, colorScheme === "dark" ? "rgb(34, 38, 45)" : "rgb(255, 255, 255)");
    await keepPicture(page, `replay-${width}-${colorScheme}`);
    assert.deepEqual(faults, []);
    await close();
  });
}

test("the keyboard alone does everything", options, async () => {
  const { page, faults, close } = await openPage(browser, address(pair));
  const time = async () => Number(await page.locator(".play").getAttribute("data-time"));
  const reach = async (selector) => {
    for (let presses = 0; presses < 40; ++presses) {
      await page.keyboard.press("Tab");
      if (await page.evaluate((wanted) => document.activeElement?.matches(wanted), selector)) return;
    }
    assert.fail(`${selector} is not reached with Tab`);
  };
  await reach(".map");
  const begin_s = await time();
  await page.keyboard.press("ArrowRight");
  assert.ok(Math.abs((await time()) - begin_s - 1) < 1e-6);
  await page.keyboard.press("Shift+ArrowRight");
  assert.ok(Math.abs((await time()) - begin_s - 11) < 1e-6);
  await page.keyboard.press("Space");
  await page.waitForFunction((from) => Number(document.querySelector(".play").dataset.time) > from, begin_s + 12);
  await page.keyboard.press("Space");
  await page.keyboard.press("f");
  assert.equal(await page.getByLabel("follow the emergency vehicle").isChecked(), false);
  await page.keyboard.press("Home");
  const first_s = await time();
  await page.keyboard.press("End");
  assert.ok((await time()) > first_s + 100);
  await reach("input[type=range]");
  await page.keyboard.press("Home");
  assert.ok(Math.abs((await time()) - first_s) < 0.06);
  await reach(".layers input");
  await page.keyboard.press("Space");
  assert.equal(await page.getByLabel("true links").isChecked(), true);
  assert.deepEqual(faults, []);
  await close();
});

/** Time and id of every emergency vehicle of the run when it enters, in that order. */
function entries() {
  const snapshot = rows(clearway("replay", run, "--csv", "snapshot")).filter((row) => row.class === "emergency");
  return [...grouped(snapshot, "vehicle")].map(([id, seen]) => ({ id, from_s: Number(seen[0].time_s), to_s: Number(seen.at(-1).time_s) }));
}

test("the emergency vehicle is one that is on the road, or the one that is chosen with the list or a key", options, async () => {
  const { page, faults, close } = await openPage(browser, address(single));
  const vehicles = entries();
  assert.ok(vehicles.length >= 3);
  const caption = () => page.locator(".caption").textContent();
  const time = async () => Number(await page.locator(".play").getAttribute("data-time"));
  const go = (time_s) => page.evaluate((wanted) => (location.hash = `time=${wanted}`), time_s);
  for (const { from_s, to_s } of vehicles) {
    await go((from_s + to_s) / 2);
    await settled(page);
    const frame_s = 0.25; // the last one before that time is shown
    const here = vehicles.filter((one) => one.from_s <= (from_s + to_s) / 2 && one.to_s >= (from_s + to_s) / 2 - frame_s);
    const text = await caption();
    assert.ok(here.some(({ id }) => text.startsWith(`corridor: ${id}, `)) && / km\/h; /.test(text), text);
  }
  const list = page.getByLabel("Emergency vehicle to follow");
  assert.equal(await list.locator("option").count(), vehicles.length + 1);
  const last = vehicles.at(-1);
  await go(vehicles[0].from_s);
  await list.selectOption(last.id);
  assert.ok(Math.abs((await time()) - last.from_s) < 0.3, "it is shown from its departure on");
  assert.match(await caption(), new RegExp(`^corridor: ${last.id}, \\d+ km/h; `));
  await page.locator(".map").focus();
  await page.keyboard.press("Shift+N");
  assert.equal(await list.inputValue(), vehicles.at(-2).id);
  await page.keyboard.press("n");
  assert.equal(await list.inputValue(), last.id);
  assert.ok(last.from_s > vehicles[0].from_s + 1);
  await go(vehicles[0].from_s + 0.5);
  await settled(page);
  assert.match(await caption(), / enters at \d+ s; /);
  assert.deepEqual(faults, []);
  await close();
});

test("a click or a key on a signal or a vehicle tells what it was asked, by which part, for whom and why", options, async () => {
  const { origin, stopLines } = readNetwork(join(folder, "runs/mine/scenarios/city/network/network.net.xml"));
  const leases = rows(clearway("replay", run, "--csv", "leases"));
  const snapshot = grouped(rows(clearway("replay", run, "--csv", "snapshot")), "time_s");
  const { page, faults, close } = await openPage(browser, address(single));
  const title = () => page.locator(".asked h4").textContent();
  const lines = () => page.locator(".asked li").allTextContents();
  assert.match(await title(), /^Click a vehicle or a signal/);
  const clickAt = async (time_s, [x, y]) => {
    await page.evaluate((hash) => (location.hash = hash), `time=${time_s}&x=${x - origin[0]}&y=${y - origin[1]}&zoom=3`);
    await settled(page);
    const box = await page.locator(".map").boundingBox();
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  };
  // A signal at a stop line that no vehicle is near.
  const places = (time_s) => snapshot.get(time_s).map((row) => [Number(row.x_m), Number(row.y_m)]);
  const isFree = (time_s, [x, y]) => places(time_s).every(([a, b]) => Math.hypot(a - x, b - y) > 12);
  const held = leases.filter((row) => row.signal !== "" && row.action === "hold_green" && row.beneficiary !== "").flatMap((row) => {
    const line = stopLines.find(({ signal, at }) => signal === row.signal && isFree(row.time_s, at));
    return line === undefined ? [] : [{ ...row, at: line.at }];
  })[0];
  assert.ok(held !== undefined);
  await clickAt(held.time_s, held.at);
  assert.ok((await title()).startsWith(`corridor, signal ${held.signal}: shows `), await title());
  const about = (row) => (line) => line.includes(` for ${row.beneficiary}: `) && line.includes(`(${row.policy})`);
  assert.ok((await lines()).some(about(held)), `${held.policy} for ${held.beneficiary} in: ${await lines()}`);
  assert.ok((await lines()).some((line) => line.includes(`green requested for ${held.beneficiary} at signal ${held.signal}`)), String(await lines()));
  // A vehicle that nothing is near.
  const driven = leases.filter((row) => row.vehicle !== "" && row.beneficiary !== "").flatMap((row) => {
    const present = snapshot.get(row.time_s).find(({ vehicle }) => vehicle === row.vehicle);
    const near = places(row.time_s).filter(([x, y]) => present && Math.hypot(x - present.x_m, y - present.y_m) < 8);
    return near.length === 1 ? [{ ...row, at: near[0] }] : [];
  })[0];
  assert.ok(driven !== undefined);
  await clickAt(driven.time_s, driven.at);
  assert.ok((await title()).startsWith(`corridor, vehicle ${driven.vehicle}: `), await title());
  assert.ok((await lines()).some(about(driven)), `${driven.policy} for ${driven.beneficiary} in: ${await lines()}`);
  await keepPicture(page, "replay-chosen");
  await page.keyboard.press("Escape");
  assert.match(await title(), /^Click a vehicle or a signal/);
  await page.keyboard.press("c");
  assert.match(await title(), /^corridor, (signal|vehicle) /);
  const first = await title();
  await page.keyboard.press("c");
  const targets = new Set(leases.filter((row) => row.time_s === driven.time_s).map((row) => row.vehicle + row.signal));
  if (targets.size > 1) assert.notEqual(await title(), first);
  assert.deepEqual(faults, []);
  await close();
});

/** The middle of a line. */
function halfWay(shape) {
  const lengths = shape.slice(1).map(([x, y], i) => Math.hypot(x - shape[i][0], y - shape[i][1]));
  let left_m = lengths.reduce((sum, one) => sum + one, 0) / 2;
  let i = 0;
  while (left_m > lengths[i]) left_m -= lengths[i++];
  const share = left_m / lengths[i];
  return [0, 1].map((axis) => shape[i][axis] + share * (shape[i + 1][axis] - shape[i][axis]));
}

/** How many pixels near the middle of a pane have a colour. */
async function near(page, pane, colour, reach = 24) {
  const { width, height, at } = await pixelsOf(page, page.locator(".map"));
  let count = 0;
  for (let dx = -reach; dx <= reach; ++dx) {
    for (let dy = -reach; dy <= reach; ++dy) count += alike(at(width * (0.25 + 0.5 * pane) + dx, height / 2 + dy), colour, 30) ? 1 : 0;
  }
  return count;
}

const red = [200, 0, 30];
const teal = [20, 150, 160];

/** Opens the page of the blocked city; `lookAt` shows a place at a moment. */
async function openBlocked(choices = {}) {
  const opened = await openPage(browser, address(blocked), choices);
  const { origin, shapes, edges } = readNetwork(join(folder, "runs/blocked/scenarios/city_v2/network/network.net.xml"));
  const lookAt = async (time_s, [x, y], zoom = 3) => {
    await opened.page.evaluate((hash) => (location.hash = hash), `time=${time_s}&x=${x - origin[0]}&y=${y - origin[1]}&zoom=${zoom}`);
    await settled(opened.page);
  };
  return { ...opened, lookAt, shapes, edges };
}

test("a blocked road is marked while it is blocked, and otherwise before it is known", options, async () => {
  const { page, faults, close, lookAt, shapes } = await openBlocked();
  assert.match(await page.locator(".legend").textContent(), /road blocked.*road blocked, not known yet/);
  const place = halfWay(shapes.get(block.lane));
  const signs = async (time_s) => {
    await lookAt(time_s, place, 2);
    return [await near(page, 0, red), await near(page, 1, red)];
  };
  const none = await signs(block.from_s - 5);
  const unknown = await signs(block.known_s - 5);
  const known = await signs(block.known_s + 5);
  const over = await signs(block.to_s + 5);
  assert.deepEqual(none, [0, 0]);
  assert.deepEqual(over, [0, 0]);
  for (const pane of [0, 1]) {
    assert.ok(unknown[pane] > 40, `a ring: ${unknown}`);
    assert.ok(known[pane] > 1.4 * unknown[pane], `a disc: ${known} pixels are red, a ring: ${unknown}`);
  }
  assert.deepEqual(faults, []);
  await close();
});

test("the way of the followed vehicle is drawn and, when it changes, both ways, with the reason among its commands", options, async () => {
  const { page, faults, close, lookAt, shapes, edges } = await openBlocked();
  const changes = rows(clearway("replay", "runs/blocked/city_v2/navigate/0", "--csv", "leases"))
    .filter(({ action, reason }) => action === "take_route" && reason === "its way is closed");
  assert.ok(changes.length > 0);
  const { vehicle, time_s, links, policy } = changes[0];
  const asked_s = Number(time_s);
  await page.getByLabel("Emergency vehicle to follow").selectOption(vehicle);
  const present = links.split(" ").map((edge) => edges[Number(edge)]);
  const middle = (edge) => halfWay(shapes.get([3, 2, 1, 0].map((lane) => `${edge}_${lane}`).find((lane) => shapes.has(lane))));
  assert.ok(!present.includes(block.edge));
  const isDrawn = async (moment_s, place) => {
    await lookAt(moment_s, place);
    return (await near(page, 1, teal)) > 20;
  };
  // Of the way that it takes, an edge that was not on its way before.
  let taken;
  for (const edge of present.slice(8, 24)) {
    if (await isDrawn(asked_s - 1, middle(edge))) continue;
    taken = middle(edge);
    break;
  }
  assert.ok(taken !== undefined, "before the change the whole new way is drawn");
  // The blocked edge is on the way that it left. Beside its sign the way is seen.
  const left = shapes.get(block.lane).at(-1);
  const ways = async (moment_s) => [await isDrawn(moment_s, left), await isDrawn(moment_s, taken)];
  assert.deepEqual(await ways(asked_s - 1), [true, false], "before the change");
  assert.deepEqual(await ways(asked_s + 1), [true, true], "both ways after the change");
  await page.getByLabel("way", { exact: true }).uncheck();
  assert.deepEqual(await ways(asked_s + 1), [false, false]);
  await page.getByLabel("way", { exact: true }).check();
  assert.deepEqual(await ways(asked_s + 35), [false, true], "later the former way is gone");

  const toChange = async () => {
    await page.evaluate((hash) => (location.hash = hash), `time=${asked_s + 1}`);
    await page.getByLabel("follow the emergency vehicle").check();
    await settled(page);
  };
  await toChange();
  const caption = await page.locator(".caption").nth(1).textContent();
  assert.match(caption, new RegExp(`${vehicle}, \\d+ km/h, another way since \\d+ s: its way is closed \\(${policy}\\); `));
  const box = await page.locator(".map").boundingBox();
  await page.mouse.click(box.x + box.width * 0.75, box.y + box.height / 2);
  assert.match(await page.locator(".asked h4").textContent(), new RegExp(`^navigate, vehicle ${vehicle}: `));
  const told = await page.locator(".asked li").allTextContents();
  const change = told.find((line) => line.includes("took another way"));
  assert.match(change ?? "", /^\d+\.\d+ s: took another way, \d+ m ahead instead of \d+ m: its way is closed \(navigate\)$/, String(told));
  assert.ok(Math.abs(Number.parseFloat(change) - asked_s) <= 1);
  assert.ok(told.some((line) => line.includes(`take another way for ${vehicle}: its way is closed`)), String(told));
  assert.match(await page.locator(".marks").getAttribute("aria-label"), /navigate: .*another way taken/);
  assert.ok((await page.locator(".marks .way").count()) > 0);
  await keepPicture(page, "blocked-1440-light");
  assert.deepEqual(faults, []);
  await close();
  for (const [width, colorScheme] of [[360, "light"], [360, "dark"], [1440, "dark"]]) {
    const other = await openBlocked({ viewport: { width, height: 800 }, colorScheme });
    await other.page.getByLabel("Emergency vehicle to follow").selectOption(vehicle);
    await other.page.evaluate((hash) => (location.hash = hash), `time=${asked_s + 1}`);
    await settled(other.page);
    assert.ok(await other.page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page is too wide");
    await keepPicture(other.page, `blocked-${width}-${colorScheme}`);
    await other.page.getByRole("button", { name: "The way ahead" }).click();
    await settled(other.page);
    const picture = await pixelsOf(other.page, other.page.locator(".map"));
    let drawn = 0;
    for (let x = 0; x < picture.width; x += 2) for (let y = 0; y < picture.height; y += 2) drawn += alike(picture.at(x, y), colorScheme === "dark" ? [62, 180, 190] : teal, 30) ? 1 : 0;
    assert.ok(drawn > 150, `${drawn} pixels of ways`);
    await keepPicture(other.page, `blocked-${width}-${colorScheme}-way`);
    await other.close();
  }
});

test("a way that is considered and not taken is dotted while it is considered, and told with both lengths", options, async () => {
  const { page, faults, close, lookAt, shapes, edges } = await openBlocked();
  const { vehicle, time_s, links } = rows(clearway("replay", "runs/blocked/city_v2/navigate/0", "--csv", "leases"))
    .find(({ action, links }) => action === "stand_back" && links !== "");
  const considered_s = Number(time_s);
  await page.getByLabel("Emergency vehicle to follow").selectOption(vehicle);
  const drawnAt = async (moment_s, place) => {
    await lookAt(moment_s, place);
    return near(page, 1, teal);
  };
  let aside;
  for (const edge of links.split(" ").map((number) => edges[Number(number)])) {
    const place = halfWay(shapes.get([3, 2, 1, 0].map((lane) => `${edge}_${lane}`).find((lane) => shapes.has(lane))));
    if ((await drawnAt(considered_s - 1, place)) > 0 || (await drawnAt(considered_s + 1, place)) === 0) continue;
    aside = place;
    break;
  }
  assert.ok(aside !== undefined, "no edge of the way is seen while it is considered, and not before");
  await page.getByLabel("way", { exact: true }).uncheck();
  assert.equal(await drawnAt(considered_s + 1, aside), 0);
  await page.getByLabel("way", { exact: true }).check();
  await page.evaluate((hash) => (location.hash = hash), `time=${considered_s + 1}`);
  await page.getByLabel("follow the emergency vehicle").check();
  await settled(page);
  const box = await page.locator(".map").boundingBox();
  await page.mouse.click(box.x + box.width * 0.75, box.y + box.height / 2);
  assert.match(await page.locator(".asked li").first().textContent(),
    /^\d+\.\d+ s to now: considered another way, \d+ m ahead instead of \d+ m: another way is faster, but not by enough \(navigate\)$/);
  assert.match(await page.locator(".legend").first().textContent(), /a way considered, not taken/);
  await page.getByRole("button", { name: "The way ahead" }).click();
  await settled(page);
  await keepPicture(page, "considered-1440-light");
  assert.deepEqual(faults, []);
  await close();
});

test("both runs show the same moment, and the marks are those of the recording", options, async () => {
  const { page, close } = await openPage(browser, address(pair));
  const events = rows(clearway("replay", run, "--csv", "events"));
  const labels = await page.locator(".marks").getAttribute("aria-label");
  const counted = (kind) => Number(new RegExp(`corridor: .*?(\\d+) ${kind}`).exec(labels)?.[1]);
  assert.equal(counted("braking"), events.filter((row) => row.event === "emergency_braking").length);
  assert.equal(counted("collision"), events.filter((row) => row.event.startsWith("collision")).length);
  assert.ok(counted("request") > 0 && counted("grant") > 0, labels);
  assert.match(labels, /baseline: 0 requests, 0 grants/);
  await close();
});

test("printed, the page keeps its maps and drops its controls", options, async () => {
  const { page, close } = await openPage(browser, address(pair));
  await page.emulateMedia({ media: "print" });
  assert.equal(await page.getByRole("button", { name: "Play or pause" }).isVisible(), false);
  assert.equal(await page.locator(".map canvas").first().isVisible(), true);
  const pdf = await page.pdf();
  assert.ok(pdf.length > 20_000);
  await close();
});

test("one page is small, whole and asks for nothing", options, () => {
  assert.ok(statSync(pair).size < 4e6, `${statSync(pair).size} bytes`);
  const text = readFileSync(pair, "utf8");
  assert.match(text, /default-src 'none'; script-src 'sha256-[A-Za-z0-9+/=]+'; style-src/);
});

test("data that was cut short, or of another format, is told", options, async () => {
  const whole = readFileSync(single, "utf8");
  const data = /(<script type="application\/json"[^>]*>)(.*?)(<\/script>)/s.exec(whole);
  const changed = (change) => {
    const json = JSON.parse(data[2]);
    change(json);
    const file = join(folder, "damaged.html");
    writeFileSync(file, whole.replace(data[2], () => JSON.stringify(json)));
    return file;
  };
  const cases = [
    [(json) => (json.format = 99), /format 99, this page reads 2/],
    [(json) => (json.plays[0].runs[0].stream = json.plays[0].runs[0].stream.slice(0, 4000)), /cannot be shown/],
    [(json) => (json.plays[0].runs[0].stream = "AAAA"), /cannot be shown/],
  ];
  for (const [change, told] of cases) {
    const { page, close } = await openPage(browser, address(changed(change)));
    assert.match(await page.locator(".failure").textContent(), told);
    await close();
  }
});
