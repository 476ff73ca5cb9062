// Turns, zooms and picks in a notebook of JupyterLab, in a browser without a screen; python/browser.sh starts it.
//   node browser.mjs URL PICTURE
import assert from "node:assert/strict";
import { chromium } from "playwright-core";

const [url, picture] = process.argv.slice(2);
const quiet = ["--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-quic"];
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu", "--no-first-run", ...quiet],
});
const page = await browser.newPage({ viewport: { width: 1000, height: 800 } });
const errors = [];
page.on("pageerror", (error) => errors.push(String(error)));

/** Executes a cell, and returns what it shows as text. */
async function execute(cell, text) {
  await page.locator(".jp-Notebook .jp-Cell .cm-content").nth(cell).click();
  await page.keyboard.press("Shift+Enter");
  if (!text) return "";
  const output = page.locator(".jp-Notebook .jp-CodeCell").nth(cell).locator(".jp-OutputArea-output");
  await output.filter({ hasText: text }).first().waitFor({ timeout: 30_000 });
  return output.first().innerText();
}

const shown = () => page.evaluate(() => document.querySelector(".pinhole-view img").src);

/** Waits until the view shows another picture than this one. */
async function after(before) {
  const other = (before) => {
    const image = document.querySelector(".pinhole-view img");
    return image && image.naturalWidth > 0 && image.src !== before;
  };
  await page.waitForFunction(other, before, { timeout: 60_000 });
  return shown();
}

await page.goto(url, { waitUntil: "load" });
await page.waitForSelector(".jp-Notebook .cm-content", { timeout: 120_000 });
await page.waitForTimeout(3_000);
await execute(0, "");
const view = page.locator(".pinhole-view");
await view.waitFor({ timeout: 60_000 }).catch(async (error) => {
  await page.screenshot({ path: picture });
  throw error;
});
let last = await after("");
assert.equal(await page.evaluate(() => document.querySelector(".pinhole-view img").naturalWidth), 480);

const box = await view.boundingBox();
const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
await page.mouse.move(x, y);
await page.mouse.down();
await page.mouse.move(x + 60, y + 20, { steps: 5 });
last = await after(last);
await page.mouse.up();
await page.mouse.wheel(0, -300);
last = await after(last);
await view.focus();
await page.keyboard.press("ArrowLeft");
last = await after(last);
await page.mouse.click(x, y);
await page.locator(".pinhole-label").filter({ hasText: "sphere" }).waitFor({ timeout: 30_000 });
const label = await page.locator(".pinhole-label").innerText();

// The kernel knows what was picked, and that the camera is nearer than at first.
const told = await execute(1, "picked");
const [, picked, zoom] = told.match(/picked (\d+) from (\d+\.\d+)/);
assert.ok(label.startsWith(`sphere ${picked},`), `${label}; ${told}`);
assert.ok(Number(zoom) < 0.5, told);
await page.screenshot({ path: picture });
assert.deepEqual(errors, []);
await browser.close();
console.log(`a view in a browser: turned, zoomed and picked: ${label}`);
