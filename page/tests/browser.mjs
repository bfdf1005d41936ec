// What the browser tests share: a real browser, the program, pictures as pixels.

import { execFileSync } from "node:child_process";
import { mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

export const folder = mkdtempSync(join(tmpdir(), "clearway-page-"));
export const patience_ms = 240_000;

/** Starts Debian's chromium, without a GPU. */
export function startBrowser() {
  return chromium.launch({
    executablePath: process.env.CLEARWAY_CHROMIUM ?? "/usr/bin/chromium",
    timeout: patience_ms,
    args: [
      "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
      "--disable-component-update", "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
    ],
  });
}

/** Opens a page that waits long and keeps what goes wrong: errors, and requests that leave it. `prepare` sees it before it loads. */
export async function openPage(browser, address, options = {}, prepare = () => {}) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, ...options });
  context.setDefaultTimeout(patience_ms);
  const page = await context.newPage();
  const faults = [];
  page.on("pageerror", (error) => faults.push(`error: ${error.message}`));
  page.on("console", (message) => {
    if (message.type() === "error") faults.push(`console: ${message.text()}`);
  });
  page.on("request", (request) => {
    if (request.url() !== address && !/^(data|blob):/.test(request.url())) faults.push(`request: ${request.url()}`);
  });
  prepare(page);
  await page.goto(address);
  await page.waitForSelector(".clearway-player[data-ready]");
  return { page, faults, close: () => context.close() };
}

/** Runs `clearway` and returns its standard output. */
export function clearway(...words) {
  return execFileSync(process.env.CLEARWAY ?? "clearway", words, {
    cwd: folder, encoding: "utf8", maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "ignore"],
  });
}

/** Lines of a CSV table as objects. No cell of these tables holds a comma or a quote. */
export function rows(csv) {
  const [head, ...lines] = csv.trim().split("\n").map((line) => line.split(","));
  return lines.map((cells) => Object.fromEntries(head.map((name, i) => [name, cells[i]])));
}

/** A picture of an element as RGBA bytes, decoded by the browser itself. */
export async function pixelsOf(page, locator) {
  const picture = (await locator.screenshot()).toString("base64");
  const { width, height, text } = await page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    let letters = "";
    for (let i = 0; i < data.length; i += 8192) letters += String.fromCharCode(...data.subarray(i, i + 8192));
    return { width: bitmap.width, height: bitmap.height, text: btoa(letters) };
  }, picture);
  const data = Buffer.from(text, "base64");
  const at = (x, y) => {
    const i = 4 * (Math.round(y) * width + Math.round(x));
    return [data[i], data[i + 1], data[i + 2]];
  };
  return { width, height, at };
}

/** Whether two colours look the same. */
export function alike(one, other, tolerance = 40) {
  return one.every((value, i) => Math.abs(value - other[i]) <= tolerance);
}

/** Waits until the map has drawn what was asked for last, and draws no more: new shaders come a moment later. */
export async function settled(page) {
  const state = () => page.locator(".play").evaluate(({ dataset }) => (dataset.shown === dataset.asked ? dataset.drawn : ""));
  for (let drawn = ""; ; ) {
    const now = await state();
    if (now !== "" && now === drawn) return;
    drawn = now;
    await page.waitForTimeout(250);
  }
}

/** Pictures to look at, where CLEARWAY_PICTURES names a folder. */
export async function keepPicture(page, name) {
  if (process.env.CLEARWAY_PICTURES === undefined) return;
  await settled(page);
  await page.screenshot({ path: join(process.env.CLEARWAY_PICTURES, `${name}.png`), fullPage: true });
}

/** Rows by the text of one cell, in their order. */
export function grouped(table, cell) {
  const groups = new Map();
  for (const row of table) {
    if (!groups.has(row[cell])) groups.set(row[cell], []);
    groups.get(row[cell]).push(row);
  }
  return groups;
}
