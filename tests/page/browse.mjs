// Opens a page in a real browser and tells what it saw, as JSON.
//   node browse.mjs PAGE [PICTURES]
// MESHGAUGE_CHROMIUM names the browser, MESHGAUGE_PLAYWRIGHT the folder of playwright-core. With a folder for PICTURES the
// page is photographed at two widths in both themes.
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const require = createRequire(resolve(process.env.MESHGAUGE_PLAYWRIGHT, "index.js"));
const { chromium } = require("playwright-core");
const [page_path, pictures] = process.argv.slice(2);
const address = pathToFileURL(resolve(page_path)).href;
const quiet = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync"];

const browser = await chromium.launch({ executablePath: process.env.MESHGAUGE_CHROMIUM, args: quiet });
const seen = { errors: [], requests: [] };

async function open(width, colorScheme, options = {}) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme, ...options });
  const page = await context.newPage();
  page.on("console", message => { if (["error", "warning"].includes(message.type())) seen.errors.push(message.text()); });
  page.on("pageerror", error => seen.errors.push(String(error)));
  page.on("dialog", dialog => { seen.errors.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  page.on("request", request => { if (request.url() !== address && !request.url().startsWith("data:")) seen.requests.push(request.url()); });
  await page.goto(address, { waitUntil: "load" });
  return page;
}
const column = (page, selector, index) => page.$$eval(`${selector} tbody tr`, (rows, index) => rows.map(row => row.cells[index].dataset.v ?? row.cells[index].textContent.trim()), index);
const paper = page => page.evaluate(() => getComputedStyle(document.body).backgroundColor);

let page = await open(1280, "light");
seen.title = await page.title();
seen.svgs = await page.$$eval("svg", all => all.length);
seen.unsized = await page.$$eval("svg", all => all.filter(svg => svg.checkVisibility() && svg.getBoundingClientRect().width < 50).length);
seen.scripts = await page.$$eval("script", all => all.length);
seen.markup = await page.$$eval("main img, main iframe, main script, main object", all => all.length);
const table = "#verdicts table";
const head = page.locator(`${table} th`, { hasText: "lowest" });
seen.unsorted = await column(page, table, 2);
const started = Date.now();
await head.click();
seen.ascending = await column(page, table, 2);
await head.click();
seen.descending = await column(page, table, 2);
seen.names = await column(page, table, 0);
await page.fill("#filter", seen.names[0]);
seen.filtered = await page.$$eval(`${table} tbody tr:not([hidden])`, rows => rows.length);
await page.fill("#filter", "");
const cumulative = page.locator(".show-cumulative").first();
seen.cumulativeBefore = await page.locator(".cumulative svg").first().isVisible();
if (await cumulative.count()) await cumulative.check();
seen.cumulativeAfter = await page.locator(".cumulative svg").first().isVisible();
await page.locator(`${table} tbody tr`).first().hover();
seen.picked = await page.$$eval("svg .on", all => all.length);
seen.milliseconds = Date.now() - started;
seen.light = await paper(page);
await page.click("#theme"); // light
await page.click("#theme"); // dark
seen.switched = await paper(page);
await page.emulateMedia({ media: "print" });
seen.printed = await paper(page);
await page.context().close();

page = await open(1280, "dark");
seen.dark = await paper(page);
await page.context().close();

page = await open(390, "light", { hasTouch: true, isMobile: true });
seen.phone = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
await page.context().close();

page = await open(1280, "light", { javaScriptEnabled: false });
seen.withoutScript = await page.locator("#figures svg").first().isVisible();
await page.context().close();

if (pictures) {
  for (const [width, name] of [[1280, "wide"], [390, "phone"]]) {
    for (const scheme of ["light", "dark"]) {
      page = await open(width, scheme);
      await page.screenshot({ path: resolve(pictures, `${name}-${scheme}.png`), fullPage: true });
      await page.context().close();
    }
  }
}
await browser.close();
console.log(JSON.stringify(seen));
