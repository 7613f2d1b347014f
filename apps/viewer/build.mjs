// Builds the page: one HTML file with its script, its worker and its style inside. Usage: node build.mjs OUT.html
import { build } from "esbuild";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2];
if (out === undefined) throw new Error("usage: node build.mjs OUT.html");

async function bundle(entry, define = {}) {
  const result = await build({
    absWorkingDir: here,
    entryPoints: [entry],
    bundle: true,
    minify: true,
    format: "esm",
    target: "es2022",
    charset: "utf8",
    legalComments: "none",
    define,
    write: false,
  });
  return result.outputFiles[0].text.trim();
}

const worker = await bundle("src/isoworker.ts");
const script = await bundle("src/main.ts", { ISO_WORKER: JSON.stringify(worker) });
const style = readFileSync(join(here, "src/style.css"), "utf8");
const licence = (name) => readFileSync(join(here, "node_modules", name, "LICENSE"), "utf8").trim();

// What would end the element, or be taken for the place of the scene, does not occur in it. Lines end as in all files of
// the project: without spaces.
const safe = script.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const page = readFileSync(join(here, "src/page.html"), "utf8")
  .replace("<!doctype html>", () => `<!doctype html>\n<!--\nBlum's viewer, Apache-2.0. It holds three.js:\n\n${licence("three")}\n\nand three-mesh-bvh:\n\n${licence("three-mesh-bvh")}\n-->`)
  .replace("/*style*/", () => style.trim())
  .replace("/*script*/", () => safe);
mkdirSync(dirname(out), { recursive: true });
writeFileSync(out, page.trimEnd() + "\n");
