// What the page's steps cost: by the kernels that it links, and by the interpreter, in turns; with the same bits.
//   crates/playground/build && node crates/playground/measure.mjs [spec] [pairs]
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const beside = path => fileURLToPath(new URL(`../../${path}`, import.meta.url)), read = path => readFileSync(beside(path), "utf8");
const compiler = new Function(`${read("crates/playground/page/compiler.js")}; return compiler;`)();
const bytes = readFileSync(beside("target/wasm32-unknown-unknown/page/lie_playground.wasm"));
const spec = process.argv[2] ?? "se3_heavy_top", declaration = read(`specs/${spec}.json`);
const STEPS = 10000, PAIRS = Number(process.argv[3] ?? 21), median = values => values.sort((a, b) => a - b)[values.length >> 1];
const asks = { webassembly: await compiler(bytes), interpreter: await compiler(bytes, false) };

for (const method of ["lie-midpoint", "gauss4", "midpoint", "rk4"]) {
  const run = engine => {
    const open = performance.now(), about = asks[engine]({ declaration, method, step: 0.01 });
    if (about.engine !== engine) throw new Error(`${engine} was asked for: ${JSON.stringify(about)}`);
    const start = performance.now(), { rows, stopped } = asks[engine]({ steps: STEPS, every: 100 });
    if (stopped) throw new Error(stopped);
    return { opened: start - open, took: performance.now() - start, rows: JSON.stringify(rows) };
  };
  const pairs = Array.from({ length: PAIRS }, () => [run("interpreter"), run("webassembly")]);
  if (pairs.some(([a, b]) => a.rows !== b.rows)) throw new Error(`${method}: rows differ`);
  const of = (which, what) => median(pairs.map(pair => pair[which][what])), rate = ms => Math.round(STEPS / ms * 1000).toLocaleString("en");
  console.log(`${spec} ${method}: interpreter ${rate(of(0, "took"))} steps/s, webassembly ${rate(of(1, "took"))} steps/s, ratio ${median(pairs.map(([a, b]) => a.took / b.took)).toFixed(2)}; opened in ${of(0, "opened").toFixed(1)} and ${of(1, "opened").toFixed(1)} ms`);
}
