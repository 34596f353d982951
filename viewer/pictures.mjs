// Pictures of pages, for the documentation:
//
//   node pictures.mjs NODE_MODULES FOLDER NAME=PAGE#ADDRESS[@dark]...
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [modules, folder, ...wanted] = process.argv.slice(2);
const { chromium } = createRequire(join(resolve(modules), "x.js"))("playwright-core");
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
for (const text of wanted) {
  const [, name, page, address, dark] = /^(.*?)=(.*?)#(.*?)(@dark)?$/.exec(text);
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, colorScheme: dark === undefined ? "light" : "dark" });
  const tab = await context.newPage();
  await tab.goto(`${pathToFileURL(resolve(page)).href}#${address}`);
  await tab.waitForSelector("main#screen");
  await tab.waitForTimeout(500);
  await tab.screenshot({ path: join(folder, `${name}.png`) });
  await context.close();
}
await browser.close();
