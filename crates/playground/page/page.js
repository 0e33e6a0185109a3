const $ = id => document.getElementById(id), dark = matchMedia("(prefers-color-scheme: dark)");
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d31", "#999999"];
let ask, about = null, playing = true, timer = 0;
let state; // what the run has left: rows to draw, the attitude, the errors

async function load() {
  const packed = Uint8Array.from(atob($("module").textContent.trim()), c => c.charCodeAt(0));
  const bytes = await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  ask = await compiler(bytes);
}

// ---- the declaration

function open(keep) {
  const text = $("declaration").value, method = $("method").value;
  $("messages").replaceChildren(); $("equations").textContent = "";
  let found;
  try { found = ask({ declaration: text, method: keep ? method : wanted(text), step: Number($("step").value), seed: Math.max(0, Math.trunc(Number($("seed").value))) || 1 }); }
  catch (error) { about = null; $("status").textContent = `a bug of the compiler: ${error}; please report it with the declaration, and load the page again`; return; }
  about = found.diagnostics || found.error ? null : found;
  for (const d of found.diagnostics || []) {
    const place = d.line ? `line ${d.line}, column ${d.column}: ` : "", button = document.createElement("button");
    button.textContent = `${place}${d.kind}: ${d.message}` + (d.help ? `\nhelp: ${d.help}` : "");
    button.onclick = () => show(d.line, d.column);
    $("messages").append(button);
  }
  if (!about) { $("status").textContent = "It does not run yet."; draw(); return; }
  $("equations").textContent = about.equations.join("\n"); $("equations").dataset.engine = about.engine;
  const chosen = about.method.split(" ")[0];
  $("method").replaceChildren(...about.methods.map(id => new Option(id, id, false, id === chosen)));
  $("method").value = chosen;
  $("of-noise").hidden = !about.noises;
  $("columns").hidden = !about.quantities.length && !about.events.length;
  if (!keep) $("inputs").replaceChildren(...about.inputs.map(({ name, value }) => {
    const label = document.createElement("label"), field = document.createElement("input");
    field.value = value; field.dataset.name = name; field.inputMode = "decimal"; label.append(`${name} `, field, " ");
    return label;
  }));
  state = { rows: [], columns: [], events: [], t: 0, first: null, errors: [], stride: 1, count: 0, q: [1, 0, 0, 0], omega: null, tip: [], names: about.invariants, stopped: null };
  advance(0);
}

/// The method that the declaration names for its runs, if it does.
function wanted(text) {
  try { const run = JSON.parse(text).run; if (run && run.step) $("step").value = run.step; return run && run.method ? run.method : ""; } catch { return ""; }
}

function show(line, column) {
  if (!line) return;
  const area = $("declaration"), before = area.value.split("\n").slice(0, line - 1).join("\n").length + (line > 1 ? 1 : 0);
  area.focus(); area.setSelectionRange(before + column - 1, before + column);
  area.scrollTop = Math.max(0, (line - 6) * 18);
}

// ---- the run

function advance(steps) {
  const n = about.coordinates.length, inputs = {};
  for (const field of $("inputs").querySelectorAll("input")) { const value = Number(field.value); if (field.value.trim() && Number.isFinite(value)) inputs[field.dataset.name] = value; }
  const answer = ask({ steps, every: Math.max(1, Math.ceil(steps / 12)), inputs });
  state.events.push(...answer.events || []); if (state.events.length > 2000) state.events.splice(0, 500);
  for (const row of answer.rows || []) {
    const t = row[0], mu = row.slice(1, n + 1), from = n + 2, behind = from + state.names.length, invariants = row.slice(from, behind), omega = row.slice(-n).slice(0, 3);
    state.columns.push([t, row[n + 1], ...row.slice(behind, behind + about.quantities.length)]); if (state.columns.length > 1500) state.columns.splice(0, 300);
    if (about.rotates && state.omega) turn(state.omega.map((w, k) => (w + omega[k]) / 2), t - state.t);
    state.omega = omega; state.t = t;
    state.rows.push([t, ...mu]); if (state.rows.length > 1500) state.rows.splice(0, 300);
    state.first ??= invariants;
    if (state.count++ % state.stride === 0) {
      // relative to the first value, unless that is round-off beside the state
      const size = Math.max(...mu.map(Math.abs)), least = 1e-12 * Math.min(size, size * size);
      state.errors.push([t, ...invariants.map((v, k) => Math.abs(v - state.first[k]) / (Math.abs(state.first[k]) > least ? Math.abs(state.first[k]) : 1))]);
      if (state.errors.length > 1200) { state.errors = state.errors.filter((_, k) => k % 2 === 0); state.stride *= 2; }
    }
    if (about.rotates) { state.tip.push(rotate(state.q, [0, 0, 1])); if (state.tip.length > 900) state.tip.splice(0, 200); }
  }
  if (answer.stopped) { state.stopped = answer.stopped; setPlaying(false); }
  const errors = state.errors.at(-1);
  const last = state.events.at(-1), seen = last ? `; ${state.events.length} events, the last ${last.event} at t = ${last.t.toPrecision(6)}` : "";
  $("status").textContent = state.stopped ?? `t = ${state.t.toPrecision(6)}` + (errors ? `; relative errors now: ${state.names.map((name, k) => `${name} ${errors[k + 1].toExponential(1)}`).join(", ")}` : "") + seen;
  draw();
}

/// The attitude a little later: R' = R hat(omega), omega in the body.
function turn(omega, dt) {
  const angle = Math.hypot(...omega) * dt / 2, part = angle === 0 ? dt / 2 : Math.sin(angle) / Math.hypot(...omega);
  const [a, b, c, d] = state.q, [w, x, y, z] = [Math.cos(angle), ...omega.map(o => o * part)];
  const q = [a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w], size = Math.hypot(...q);
  state.q = q.map(e => e / size);
}
function rotate([w, x, y, z], [a, b, c]) {
  const [u, v, s] = [y * c - z * b, z * a - x * c, x * b - y * a];
  return [a + 2 * (w * u + y * s - z * v), b + 2 * (w * v + z * u - x * s), c + 2 * (w * s + x * v - y * u)];
}

function tick() {
  if (about && playing && !document.hidden) {
    const step = Math.abs(Number($("step").value)) || 0.01, speed = Math.max(0, Number($("speed").value) || 0);
    const start = performance.now(), wanted = Math.round(Math.min(20000, speed / 30 / step));
    if (wanted > 0) advance(Math.min(wanted, tick.most));
    const took = performance.now() - start;
    tick.most = Math.max(1, Math.round(took > 25 ? tick.most * 0.6 : Math.min(20000, tick.most * 1.2 + 1)));
  }
  timer = setTimeout(tick, 33);
}
tick.most = 200;
function setPlaying(on) { playing = on; $("play").textContent = on ? "Pause" : "Go on"; }

// ---- pictures

let azimuth = 0.7, elevation = 0.4;
function paper(canvas) {
  const scale = Math.min(devicePixelRatio || 1, 2), [w, h] = [canvas.clientWidth, canvas.clientHeight], pen = canvas.getContext("2d");
  canvas.width = w * scale; canvas.height = h * scale; pen.setTransform(scale, 0, 0, scale, 0, 0);
  pen.fillStyle = dark.matches ? "#15181c" : "#ffffff"; pen.fillRect(0, 0, w, h);
  pen.fillStyle = pen.strokeStyle = dark.matches ? "#e6e8eb" : "#1b1f24"; pen.font = "13px system-ui, sans-serif";
  return [pen, w, h];
}
function camera(w, h, size) {
  const [s, c, t, d] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
  const right = [-s, c, 0], up = [-t * c, -t * s, d], eye = [d * c, d * s, t], dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2], fit = 0.42 * Math.min(w, h) / size;
  return { place: p => [w / 2 + fit * dot(right, p), h / 2 - fit * dot(up, p)], depth: p => dot(eye, p) };
}
function line(pen, points, paint, width) {
  pen.strokeStyle = paint; pen.lineWidth = width; pen.beginPath();
  points.forEach(([x, y], k) => k ? pen.lineTo(x, y) : pen.moveTo(x, y)); pen.stroke();
}
/// Into how many parts lines from row to row are to be divided: more than one where they turn.
function bends(points) {
  const turns = [], last = points.slice(-64);
  for (let k = 2; k < last.length; k++) {
    const [a, b] = [1, 2].map(at => last[k - 2 + at].map((x, i) => x - last[k - 3 + at][i]));
    const cosine = a.reduce((sum, x, i) => sum + x * b[i], 0) / (Math.hypot(...a) * Math.hypot(...b));
    if (Number.isFinite(cosine)) turns.push(Math.acos(Math.min(1, Math.max(-1, cosine))));
  }
  const turn = turns.sort((x, y) => x - y)[Math.floor(0.9 * turns.length)];
  return points.length >= 6 && turn > 0.2 ? Math.min(10, Math.ceil(turn / 0.08)) : 1;
}
/// Points at equal times with others between them, on the polynomials through six neighbours.
function curve(points, parts) {
  if (parts < 2 || points.length < 6) return points;
  const found = [], all = points.length, six = [0, 1, 2, 3, 4, 5];
  for (let k = 0; k + 1 < all; k++) {
    const base = Math.min(Math.max(k - 2, 0), all - 6);
    for (let part = 0; part < parts; part++) {
      const x = k - base + part / parts, weights = six.map(j => six.reduce((w, i) => i === j ? w : w * (x - i) / (j - i), 1));
      found.push(part ? points[k].map((_, i) => six.reduce((sum, j) => sum + weights[j] * points[base + j][i], 0)) : points[k]);
    }
  }
  return [...found, points[all - 1]];
}
/// The rows as dots, where they are few and lines between them are divided.
function dots(pen, places, parts, paint) {
  if (parts < 2 || places.length > 200) return;
  pen.fillStyle = paint;
  for (const [x, y] of places) { pen.beginPath(); pen.arc(x, y, 2.2, 0, 7); pen.fill(); }
}
const SIDES = [0.62, 0.4, 0.2], FACES = [[0, 1], [0, -1], [1, 1], [1, -1], [2, 1], [2, -1]];
function drawBody() {
  const [pen, w, h] = paper($("body"));
  if (!about || !state) return;
  if (about.rotates) {
    const view = camera(w, h, 1.15), q = state.q, ring = Array.from({ length: 73 }, (_, k) => k * Math.PI / 36);
    for (const circle of [ring.map(a => [Math.cos(a), Math.sin(a), 0]), ring.map(a => [Math.cos(a), 0, Math.sin(a)]), ring.map(a => [0, Math.cos(a), Math.sin(a)])])
      line(pen, circle.map(view.place), dark.matches ? "#3a4048" : "#dde1e5", 1);
    const faces = FACES.map(([axis, sign]) => {
      const [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
      const corners = [[1, 1], [1, -1], [-1, -1], [-1, 1]].map(([a, b]) => { const p = [0, 0, 0]; p[axis] = sign * SIDES[axis]; p[i] = a * SIDES[i]; p[j] = b * SIDES[j]; return rotate(q, p); });
      const normal = [0, 0, 0]; normal[axis] = sign; const out = rotate(q, normal);
      return { corners, paint: axis, depth: view.depth(corners.reduce((m, p) => m.map((x, k) => x + p[k] / 4), [0, 0, 0])), light: 0.55 + 0.45 * Math.max(0, view.depth(out)) };
    }).sort((a, b) => a.depth - b.depth);
    const parts = bends(state.tip);
    line(pen, curve(state.tip, parts).map(view.place), COLOURS[1], 1.4);
    dots(pen, state.tip.map(view.place), parts, COLOURS[1]);
    for (const face of faces) {
      pen.beginPath(); face.corners.map(view.place).forEach(([x, y], k) => k ? pen.lineTo(x, y) : pen.moveTo(x, y)); pen.closePath();
      pen.fillStyle = ["#5b8fc4", "#e2a35b", "#69b391"][face.paint]; pen.globalAlpha = 1; pen.fill();
      pen.fillStyle = "#000"; pen.globalAlpha = 1 - face.light; pen.fill(); pen.globalAlpha = 1;
      pen.strokeStyle = "#0006"; pen.lineWidth = 1; pen.stroke();
    }
    pen.fillStyle = dark.matches ? "#a0a8b1" : "#59636e"; pen.fillText("the attitude, and the path of the third axis; drag to turn the view", 10, h - 10);
  } else if (about.coordinates.length === 3 && state.rows.length) {
    const size = Math.max(...state.rows.map(row => Math.hypot(row[1], row[2], row[3])), 1e-300), view = camera(w, h, size);
    [0, 1, 2].forEach(k => { const a = [0, 0, 0]; a[k] = size; line(pen, [[0, 0, 0], a].map(view.place), dark.matches ? "#3a4048" : "#c9ced4", 1); pen.fillText(about.coordinates[k], ...view.place(a)); });
    const rows = state.rows.map(row => row.slice(1)), parts = bends(rows);
    line(pen, curve(rows, parts).map(view.place), COLOURS[0], 1.5);
    dots(pen, rows.map(view.place), parts, COLOURS[0]);
    const [x, y] = view.place(state.rows.at(-1).slice(1)); pen.fillStyle = COLOURS[1]; pen.beginPath(); pen.arc(x, y, 5, 0, 7); pen.fill();
  } else chart(pen, w, h, state.rows, about.coordinates, x => x, "coordinates", bends(state.rows.map(row => row.slice(1))));
}
function chart(pen, w, h, rows, names, scale, title, parts = 1, marks = []) {
  const left = 58, bottom = h - 24, right = w - 12, top = 26, shown = Math.min(names.length, 8);
  if (shown < names.length) title += ` (the first ${shown} of ${names.length})`;
  pen.textAlign = "left"; pen.fillText(title, left, 16);
  let x0 = left + pen.measureText(title).width + 16;
  for (let k = 0; k < shown; k++) { pen.fillStyle = COLOURS[k]; pen.fillText(names[k], x0, 16); x0 += pen.measureText(names[k]).width + 12; }
  if (rows.length < 2) return;
  const drawn = curve(rows, parts);
  const values = drawn.flatMap(row => row.slice(1, shown + 1)).filter(v => scale(v) !== null && Number.isFinite(scale(v))).map(scale);
  if (!values.length) return;
  let [low, high] = [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
  if (scale(1e-3) === -3) { low = Math.floor(Math.min(low, -16)); high = Math.ceil(Math.max(high, -14)); } else if (high - low <= 1e-12 * Math.max(Math.abs(low), Math.abs(high))) { const half = 0.1 * Math.max(Math.abs(low), Math.abs(high)) || 1; low -= half; high += half; }
  const [t0, t1] = [rows[0][0], rows.at(-1)[0]], X = t => left + (right - left) * (t - t0) / (t1 - t0 || 1), Y = v => bottom - (bottom - top) * (v - low) / (high - low);
  const faint = dark.matches ? "#a0a8b1" : "#59636e", grid = dark.matches ? "#2b3036" : "#e4e7ea", logs = scale(1e-3) === -3;
  pen.fillStyle = faint; pen.textAlign = "right";
  const lines = logs ? Array.from({ length: high - low + 1 }, (_, k) => low + k).filter((_, k, all) => k % Math.ceil(all.length / 6) === 0) : [low, (low + high) / 2, high];
  for (const v of lines) { line(pen, [[left, Y(v)], [right, Y(v)]], grid, 1); pen.fillText(logs ? `1e${v}` : v.toPrecision(3), left - 6, Y(v) + 4); }
  pen.fillText(`t = ${t1.toPrecision(4)}`, right, h - 7); pen.textAlign = "left"; pen.fillText(t0.toPrecision(4), left, h - 7);
  for (const { event, t } of marks) if (t >= t0 && t <= t1) line(pen, [[X(t), top], [X(t), bottom]], COLOURS[about.events.indexOf(event) % 8] + "66", 1);
  for (let k = 0; k < shown; k++) {
    const places = of => of.filter(row => scale(row[k + 1]) !== null).map(row => [X(row[0]), Y(scale(row[k + 1]))]);
    line(pen, places(drawn), COLOURS[k], 1.3);
    dots(pen, places(rows), parts, COLOURS[k]);
  }
}
function draw() {
  drawBody();
  if (about && state && !$("columns").hidden) {
    const [pen, w, h] = paper($("columns"));
    chart(pen, w, h, state.columns, ["energy", ...about.quantities], x => x, about.events.length ? `lines: ${about.events.join(", ")}` : "columns", 1, state.events);
  }
  const [pen, w, h] = paper($("drift"));
  if (about && state) chart(pen, w, h, state.errors, state.names, v => v > 0 ? Math.log10(v) : null, "relative errors");
}

// ---- what the reader does

const canvas = $("body"); let held = null;
canvas.onpointerdown = event => { held = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); };
canvas.onpointerup = canvas.onpointercancel = () => { held = null; };
canvas.onpointermove = event => {
  if (!held) return;
  azimuth -= (event.clientX - held[0]) / 150; elevation = Math.min(1.57, Math.max(-1.57, elevation + (event.clientY - held[1]) / 150));
  held = [event.clientX, event.clientY]; draw();
};
$("play").onclick = () => setPlaying(!playing);
$("again").onclick = () => { setPlaying(true); open(true); };
$("method").onchange = () => { setPlaying(true); open(true); };
$("step").onchange = $("seed").onchange = () => { setPlaying(true); open(true); };
let typed = 0;
$("declaration").oninput = () => { clearTimeout(typed); typed = setTimeout(() => { setPlaying(true); open(false); }, 400); };
$("examples").onchange = () => { $("declaration").value = $(`spec-${$("examples").value}`).textContent.trim(); setPlaying(true); open(false); };
addEventListener("resize", draw); dark.addEventListener("change", draw);

load().then(() => {
  const specs = [...document.querySelectorAll("script[id^=spec-]")].map(script => script.id.slice(5));
  $("examples").replaceChildren(...specs.map(name => new Option(name, name)));
  $("declaration").value = $(`spec-${specs[0]}`).textContent.trim();
  open(false); tick();
}).catch(error => { $("status").textContent = `The compiler does not load in this browser: ${error}`; });
