// Pages of `rondo view` in a real browser: every screen, keys alone, what people with screen readers get, and that nothing is ever loaded.
//
//   node pages.mjs NODE_MODULES PICTURES PAGE...
import assert from "node:assert";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [modules, pictures, ...pages] = process.argv.slice(2);
const require = createRequire(join(resolve(modules), "x.js"));
const { chromium } = require("playwright-core");
const axe = readFileSync(join(resolve(modules), "axe-core/axe.min.js"), "utf8");
const SCREENS = ["run", "story", "states", "plots", "events", "source"];

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

async function open(file, options) {
  const context = await browser.newContext({ bypassCSP: false, ...options });
  const page = await context.newPage();
  const seen = { errors: [], requests: [] };
  page.on("console", (message) => message.type() === "error" && seen.errors.push(message.text()));
  page.on("pageerror", (error) => seen.errors.push(error.message));
  page.on("request", (request) => !/^(data|blob):/.test(request.url()) && seen.requests.push(request.url()));
  await page.goto(pathToFileURL(file).href);
  await page.waitForSelector("main#screen");
  return { context, page, seen };
}

const look = (page) => page.evaluate(() => ({ ...window.rondo.state.look, playing: window.rondo.state.playing }));

async function screens(file, name, scheme, size) {
  const { context, page, seen } = await open(file, { viewport: size, colorScheme: scheme, reducedMotion: "reduce" });
  await page.evaluate(() => window.rondo.state.change({ time: window.rondo.state.recording.end / 2 }));
  for (const [i, screen] of SCREENS.entries()) {
    await page.keyboard.press(String(i + 1));
    assert.equal((await look(page)).screen, screen);
    await page.waitForTimeout(150);
    if (screen === "run") assert.ok((await page.evaluate(() => window.rondo.stage.drawCalls())) <= 40, `${name}: draw calls`);
    // The page's own rules let no script in: axe is run from outside of them.
    const found = await page.evaluate(`${axe}; axe.run()`).then((r) => r.violations);
    assert.deepEqual(found.map((v) => `${screen}: ${v.id}: ${v.nodes.length} x ${v.nodes[0].html.slice(0, 120)}`), [], `${name} ${scheme}`);
    if (pictures !== "-") await page.screenshot({ path: join(pictures, `${name}-${screen}-${scheme}-${size.width}.png`) });
  }
  assert.deepEqual(seen.errors, [], name);
  assert.deepEqual(seen.requests, [pathToFileURL(file).href], `${name}: nothing but itself`);
  await context.close();
}

async function keys(file) {
  const { context, page } = await open(file, { viewport: { width: 1280, height: 800 } });
  const end = await page.evaluate(() => window.rondo.state.recording.end);
  await page.keyboard.press("End");
  assert.equal((await look(page)).time, end);
  await page.keyboard.press("Home");
  assert.equal((await look(page)).time, 0);
  await page.keyboard.press("ArrowRight");
  const one = (await look(page)).time;
  assert.ok(one > 0 && one <= 1.01);
  await page.keyboard.press("ArrowLeft");
  assert.equal((await look(page)).time, 0);
  await page.keyboard.press("Shift+ArrowRight");
  assert.ok((await look(page)).time > 0);
  await page.keyboard.press("j");
  assert.equal((await look(page)).robot, 0);
  await page.keyboard.press("k");
  assert.ok((await look(page)).robot >= 0);
  await page.keyboard.press("f");
  await page.keyboard.press("t");
  assert.deepEqual([(await look(page)).follow, (await look(page)).from], [true, "top"]);
  await page.waitForTimeout(200);
  // The address has everything: somebody else who opens it sees the same.
  const address = page.url();
  const other = await context.newPage();
  await other.goto(address);
  await other.waitForSelector("main#screen");
  const [mine, theirs] = [await look(page), await look(other)];
  assert.deepEqual({ ...theirs, time: theirs.time.toFixed(3) }, { ...mine, time: mine.time.toFixed(3) });
  await other.close();
  await page.keyboard.press("Escape");
  await page.keyboard.press("Space");
  assert.ok((await look(page)).playing);
  const before = (await look(page)).time;
  await page.waitForTimeout(300);
  assert.ok((await look(page)).time > before);
  await page.keyboard.press("Space");
  assert.ok(!(await look(page)).playing);
  await page.keyboard.press("/");
  await page.keyboard.type("zzzz");
  assert.equal(await page.locator("tbody tr").count(), 0);
  await page.keyboard.press("Escape");
  await page.keyboard.press("?");
  assert.ok(await page.locator("dialog").isVisible());
  await page.keyboard.press("Escape");
  assert.ok(!(await page.locator("dialog").isVisible()));
  // Tab alone reaches everything that can be pressed.
  await page.keyboard.press("1");
  const wanted = await page.locator("button:visible, select:visible, input:visible").count();
  const reached = new Set();
  for (let i = 0; i < wanted + 10; ++i) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => `${document.activeElement?.tagName} ${document.activeElement?.textContent} ${document.activeElement?.getAttribute("aria-label")}`));
  }
  assert.ok(reached.size >= wanted, `${reached.size} of ${wanted}`);
  await context.close();
}

let count = 0;
for (const file of pages.map((p) => resolve(p))) {
  const name = file.replace(/^.*\/|\.html$/g, "");
  await screens(file, name, count % 2 === 0 ? "light" : "dark", { width: 1280, height: 800 });
  if (count === 0 || pictures !== "-") {
    await screens(file, name, count % 2 === 0 ? "dark" : "light", { width: 1920, height: 1080 });
    await keys(file);
  }
  ++count;
}
await browser.close();
console.log(`${count} pages`);
