// A report with replays, in a real browser: a page from disk that plays trips among its tables and figures.

import assert from "node:assert/strict";
import { readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { alike, clearway, folder, keepPicture, openPage, patience_ms, pixelsOf, settled, startBrowser } from "./browser.mjs";
import { classColours } from "./screen.mjs";

const options = { timeout: 4 * patience_ms };
const report = join(folder, "runs/study/report.html");
const address = pathToFileURL(report).href;
let browser;
let plain_bytes;

before(async () => {
  clearway("run", "city", "--seeds", "3", "--no-solo", "--out", "runs/study");
  plain_bytes = statSync(report).size;
  clearway("report", "runs/study", "--replays");
  browser = await startBrowser();
}, options);
after(() => browser?.close());

const timeOf = async (page) => Number(await page.locator(".play").getAttribute("data-time"));
const isPlaying = (page, from_s) =>
  page.waitForFunction((from) => Number(document.querySelector(".play").dataset.time) > from, from_s);

test("replays make the page at most 4 MB larger, and it may load and evaluate nothing", options, () => {
  const grown = statSync(report).size - plain_bytes;
  assert.ok(grown > 100_000 && grown <= 4_000_000, `${grown} bytes`);
  const policy = /Content-Security-Policy" content="([^"]*)"/.exec(readFileSync(report, "utf8"))[1];
  assert.match(policy, /^default-src 'none'; style-src 'unsafe-inline'; img-src data:; script-src( 'sha256-[A-Za-z0-9+/=]+'){2}$/);
});

/** The followed vehicle's front is in the middle of each pane. */
async function expectFollowed(page) {
  const picture = await pixelsOf(page, page.locator(".map"));
  const isStacked = await page.locator(".map").evaluate((map) => map.classList.contains("stacked"));
  for (const share of [0.25, 0.75]) {
    const [x, y] = isStacked ? [picture.width / 2, picture.height * share] : [picture.width * share, picture.height / 2];
    let red = 0;
    for (let dy = -12; dy <= 12; ++dy) for (let dx = -12; dx <= 12; ++dx) red += alike(picture.at(x + dx, y + dy), classColours.emergency) ? 1 : 0;
    assert.ok(red >= 20, `${red} red pixels in the middle of a pane`);
  }
}

for (const [width, colorScheme] of [[360, "light"], [360, "dark"], [768, "dark"], [1440, "light"]]) {
  test(`a trip plays, is scrubbed and followed at ${width} px, ${colorScheme}`, options, async () => {
    const { page, faults, close } = await openPage(browser, address, { viewport: { width, height: 800 }, colorScheme });
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page is too wide");
    const trips = await page.locator(".menu select").locator("option").allTextContents();
    assert.deepEqual(trips.map((text) => /^city: the (median|best|worst) trip/.exec(text)?.[1]), ["median", "best", "worst"]);
    for (const i of [2, 0]) {
      await page.locator(".menu select").selectOption(String(i));
      await page.waitForFunction((n) => document.querySelectorAll(".play").length === 1 && Number(document.querySelector(".menu select").value) === n, i);
      await settled(page);
      const begin_s = await timeOf(page);
      await page.getByLabel("Speed").selectOption("10");
      await page.getByRole("button", { name: "Play or pause" }).click();
      await isPlaying(page, begin_s + 2);
      await page.getByRole("button", { name: "Play or pause" }).click();
      const slider = page.getByLabel("Time, seconds of the simulation");
      const [low, high] = await slider.evaluate(({ min, max }) => [Number(min), Number(max)]);
      await slider.fill(String(Math.round((low + high) / 2)));
      await settled(page);
      assert.ok(Math.abs((await timeOf(page)) - (low + high) / 2) <= 0.5);
      const captions = await page.locator(".play .caption").allTextContents();
      assert.match(captions[0], /^Baseline: \S+, \d+ km\/h; \d+ vehicles$/);
      assert.match(captions[1], /^corridor: \S+, \d+ km\/h; \d+ vehicles$/);
      await expectFollowed(page);
    }
    const [one, other] = await Promise.all([0, 1].map((i) => page.locator(".curves figure").nth(i).boundingBox()));
    assert.ok(one.width > 250 && other.width > 250 && one.height < 220, "the curves have room");
    assert.ok(other.x >= one.x + one.width || other.y >= one.y + one.height, "the curves do not overlap");
    await keepPicture(page, `report-${width}-${colorScheme}`);
    assert.deepEqual(faults, []);
    await close();
  });
}

test("with the keyboard alone a trip is chosen, played and scrubbed", options, async () => {
  const { page, faults, close } = await openPage(browser, address);
  const reach = async (selector) => {
    for (let presses = 0; presses < 300; ++presses) {
      await page.keyboard.press("Tab");
      if (await page.evaluate((wanted) => document.activeElement?.matches(wanted), selector)) return;
    }
    assert.fail(`${selector} is not reached with Tab`);
  };
  await reach(".clearway-player .menu select");
  await page.keyboard.press("ArrowDown");
  await page.waitForFunction(() => document.querySelector(".menu select").value === "1");
  await settled(page);
  await reach(".clearway-player .map");
  const begin_s = await timeOf(page);
  await page.keyboard.press("ArrowRight");
  assert.ok(Math.abs((await timeOf(page)) - begin_s - 1) < 1e-6);
  await page.keyboard.press("Space");
  await isPlaying(page, begin_s + 2);
  await page.keyboard.press("Space");
  assert.deepEqual(faults, []);
  await close();
});

test("with less motion asked for, a picture stands for a simulated second", options, async () => {
  const { page, faults, close } = await openPage(browser, address, { reducedMotion: "reduce" });
  await page.evaluate(() => {
    window.times = new Set();
    new MutationObserver(() => window.times.add(document.querySelector(".play").dataset.time)).observe(
      document.querySelector(".play"), { attributes: true, attributeFilter: ["data-time"] });
  });
  const begin_s = await timeOf(page);
  await page.getByLabel("Speed").selectOption("5");
  await page.getByRole("button", { name: "Play or pause" }).click();
  await isPlaying(page, begin_s + 8);
  await page.getByRole("button", { name: "Play or pause" }).click();
  const steps = (await page.evaluate(() => [...window.times])).map((time) => Number(time) - begin_s);
  assert.ok(steps.length >= 3, `${steps}`);
  assert.ok(steps.every((step) => Math.abs(step - Math.round(step)) < 1e-6), `${steps}`);
  assert.deepEqual(faults, []);
  await close();
});

test("printed, folded sections are unfolded and the map stays without its controls", options, async () => {
  const { page, faults, close } = await openPage(browser, address, { colorScheme: "dark" });
  const folded = page.locator("details.section > section");
  assert.ok((await folded.count()) >= 5);
  assert.equal(await folded.first().isVisible(), false);
  await page.emulateMedia({ media: "print" });
  for (let i = 0; i < (await folded.count()); ++i)
    assert.ok((await folded.nth(i).boundingBox()).height > 20, `section ${await folded.nth(i).getAttribute("id")}`);
  assert.equal(await page.getByRole("button", { name: "Play or pause" }).isVisible(), false);
  assert.equal(await page.locator(".map canvas").first().isVisible(), true);
  const [paper, ink] = await page.locator(".clearway-player").evaluate((place) => [getComputedStyle(document.body).backgroundColor, getComputedStyle(place).color]);
  const light = (colour) => /\d+(\.\d+)?/g[Symbol.match](colour).slice(0, 3).reduce((sum, part) => sum + Number(part), 0) / 3;
  assert.ok(paper === "rgba(0, 0, 0, 0)" || light(paper) > 240, paper);
  assert.ok(light(ink) < 100, `ink ${ink} on paper`);
  assert.ok((await page.pdf()).length > 20_000);
  assert.deepEqual(faults, []);
  await close();
});
