// The scene is lines in space with the normals of the surface that they lie on; dragging turns it.
(() => {
  const canvas = document.getElementById("orbit"), scene = JSON.parse(document.getElementById("scene").textContent);
  const pen = canvas.getContext("2d"), dark = matchMedia("(prefers-color-scheme: dark)");
  const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
  let azimuth = 0.6, elevation = 0.45, zoom = 1;
  const middle = scene.middle, size = scene.size;
  function draw() {
    const side = canvas.clientWidth, scale = Math.min(devicePixelRatio || 1, 2);
    canvas.width = canvas.height = side * scale;
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    const [s, c, t, d] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
    const right = [-s, c, 0], up = [-t * c, -t * s, d], eye = [d * c, d * s, t];
    const dot = (a, p, k) => a[0] * p[k] + a[1] * p[k + 1] + a[2] * p[k + 2];
    const fit = zoom * 0.92 * side / size, centre = [dot(right, middle, 0), dot(up, middle, 0)];
    const x = (p, k) => side / 2 + fit * (dot(right, p, k) - centre[0]), y = (p, k) => side / 2 - fit * (dot(up, p, k) - centre[1]);
    const ink = dark.matches ? "#e6e8eb" : "#1b1f24", paper = dark.matches ? "#15181c" : "#ffffff";
    pen.fillStyle = paper; pen.fillRect(0, 0, side, side);
    // each line holds x, y, z of its points, then the normals
    function lines(all, front, paint, width, alpha) {
      pen.strokeStyle = paint; pen.lineWidth = width; pen.globalAlpha = alpha; pen.beginPath();
      for (const line of all) {
        const n = line.length / 2; let on = false;
        for (let k = 0; k < n; k += 3) {
          const seen = dot(eye, line, n + k) >= 0;
          if (on) pen.lineTo(x(line, k), y(line, k)); else if (seen === front) pen.moveTo(x(line, k), y(line, k));
          on = seen === front;
        }
      }
      pen.stroke(); pen.globalAlpha = 1;
    }
    const grey = dark.matches ? "#7d8790" : "#9aa3ac";
    lines(scene.levels, false, grey, 0.7, 0.35);
    scene.curves.forEach((curve, k) => lines([curve], false, colours[k % colours.length], 1.1, 0.35));
    lines(scene.levels, true, grey, 0.9, 1);
    scene.curves.forEach((curve, k) => lines([curve], true, colours[k % colours.length], 1.7, 1));
    scene.curves.forEach((curve, k) => { pen.fillStyle = colours[k % colours.length]; pen.beginPath(); pen.arc(x(curve, 0), y(curve, 0), 4, 0, 7); pen.fill(); });
    pen.strokeStyle = pen.fillStyle = ink; pen.font = "14px system-ui, sans-serif"; pen.textAlign = "center"; pen.lineWidth = 1.2;
    scene.axes.forEach((name, k) => {
      const a = [0, 0, 0]; a[k] = 1;
      const [dx, dy] = [dot(right, a, 0), -dot(up, a, 0)], [ox, oy] = [54, side - 54];
      pen.beginPath(); pen.moveTo(ox, oy); pen.lineTo(ox + 34 * dx, oy + 34 * dy); pen.stroke();
      pen.fillText(name, ox + 45 * dx, oy + 45 * dy + 5);
    });
  }
  const pointers = new Map(); let spread = 0;
  canvas.addEventListener("pointerdown", event => { pointers.set(event.pointerId, event); spread = 0; canvas.setPointerCapture(event.pointerId); });
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, event => { pointers.delete(event.pointerId); spread = 0; });
  canvas.addEventListener("pointermove", event => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    pointers.set(event.pointerId, event);
    if (pointers.size === 2) {
      const [a, b] = [...pointers.values()], now = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
      if (spread) zoom = Math.min(20, Math.max(0.3, zoom * now / spread));
      spread = now;
    } else {
      azimuth -= (event.clientX - before.clientX) / 150;
      elevation = Math.min(1.57, Math.max(-1.57, elevation + (event.clientY - before.clientY) / 150));
    }
    draw();
  });
  canvas.addEventListener("keydown", event => {
    const turn = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
    if (!turn) return;
    azimuth += turn[0]; elevation += turn[1]; event.preventDefault(); draw();
  });
  canvas.addEventListener("wheel", event => { if (event.ctrlKey) { zoom = Math.min(20, Math.max(0.3, zoom * Math.exp(-event.deltaY / 300))); event.preventDefault(); draw(); } }, { passive: false });
  addEventListener("resize", draw); dark.addEventListener("change", draw); draw();
})();
