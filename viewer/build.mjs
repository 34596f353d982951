// Makes the one page of the viewer: scripts and styles inside, nothing else is ever loaded.
//
//   node viewer/build.mjs OUTPUT --modules NODE_MODULES
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const [output, flag, modules] = process.argv.slice(2);
if (output === undefined || flag !== "--modules" || modules === undefined) {
  console.error("usage: build.mjs OUTPUT --modules NODE_MODULES");
  process.exit(2);
}
const require = createRequire(join(resolve(modules), "x.js"));
const esbuild = require("esbuild");

const bundled = await esbuild.build({
  entryPoints: [join(here, "src/main.ts")],
  bundle: true,
  write: false,
  minify: true,
  format: "iife",
  target: "es2022",
  nodePaths: [resolve(modules)],
  legalComments: "eof",
  logLevel: "error",
});
const escaped = (text) => text.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const script = escaped(bundled.outputFiles[0].text);
const style = readFileSync(join(resolve(modules), "uplot/dist/uPlot.min.css"), "utf8") + readFileSync(join(here, "src/style.css"), "utf8");
const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const policy = `default-src 'none'; script-src ${hash(script)}; style-src ${hash(style)}; img-src blob: data:; base-uri 'none'; form-action 'none'`;
// `rondo view` puts data where the comment stands.
writeFileSync(output, `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<meta name="viewport" content="width=device-width">
<title>Rondo</title>
<link rel="icon" href="data:,">
<style>${style}</style>
</head>
<body>
<!--rondo-data-->
<script>${script}</script>
</body>
</html>
`);
