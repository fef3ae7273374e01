// Moves the robot in its modes. Where anything is missing the static figure stays.
(async () => {
  const root = document.querySelector(".mode-viewer");
  const inside = (selector) => root.querySelector(selector);
  const canvas = inside("canvas"), pen = canvas.getContext("2d");
  if (!pen || typeof DecompressionStream === "undefined") return;
  const robot = JSON.parse(inside(".mv-robot").textContent);
  const packed = Uint8Array.from(atob(inside(".mv-shapes").textContent), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const buffer = await new Response(stream).arrayBuffer();
  const { cables: m, points: p, modes } = robot, FULL = 32767, CYCLE = 2.0;
  const rest = new Float32Array(buffer, 0, 3 * m * p);
  let place = rest.byteLength;
  const shapes = modes.map((mode) => {
    const shape = new Int16Array(buffer, place, 3 * m * ((p - 1) / mode.stride + 1));
    place += shape.byteLength;
    return shape;
  });
  const [low, high] = robot.box, size = Math.hypot(...high.map((v, i) => v - low[i]));
  const power = 10 ** Math.floor(Math.log10(0.12 * size));
  const arrow = [5, 2, 1].map((v) => v * power).find((v) => v <= 0.12 * size);
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const state = { mode: 0, playing: !still, phase: 0.5 * Math.PI, yaw: 28, pitch: 20, zoom: 1, amplitude: 5, seen: true };
  root.hidden = false;
  root.closest("figure").classList.add("live");

  // Projection: parallel, to scale; `fit` finds where all of the robot and its motion is inside the canvas.
  let right, up, scale, middle, width, height;
  const flat = (x, y, z) => [x * right[0] + y * right[1], x * up[0] + y * up[1] + z * up[2]];
  const screen = (x, y, z) => {
    const [a, b] = flat(x, y, z);
    return [0.5 * width + scale * (a - middle[0]), 0.5 * height - scale * (b - middle[1])];
  };
  function fit() {
    const [yaw, pitch] = [state.yaw, state.pitch].map((v) => (v * Math.PI) / 180);
    right = [Math.cos(yaw), Math.sin(yaw)];
    up = [-Math.sin(pitch) * Math.sin(yaw), Math.sin(pitch) * Math.cos(yaw), Math.cos(pitch)];
    const ends = [Infinity, Infinity, -Infinity, -Infinity];
    const take = (x, y, z) => flat(x, y, z).forEach((v, i) => {
      ends[i] = Math.min(ends[i], v);
      ends[i + 2] = Math.max(ends[i + 2], v);
    });
    for (const x of [low[0], high[0]]) for (const y of [low[1], high[1]]) take(x, y, low[2]);
    for (const anchor of robot.anchors) take(...anchor);
    take(low[0], low[1], low[2] + 1.4 * arrow);
    for (let i = 0; i < rest.length; i += 12) take(rest[i], rest[i + 1], rest[i + 2]);
    const moved = 0.02 * state.amplitude * size, margin = 26;
    scale = state.zoom * Math.min((width - 2 * margin) / (ends[2] - ends[0] + moved), (height - 2 * margin) / (ends[3] - ends[1] + moved));
    middle = [0.5 * (ends[0] + ends[2]), 0.5 * (ends[1] + ends[3])];
  }

  // How far the shape is out at this instant [m per unit], and the platform's rigid motion.
  const gain = () => ((0.01 * state.amplitude * size) / (modes[state.mode].reach || 1)) * Math.sin(state.phase);
  function carried([x, y, z], g) {
    const [u, v, w, a, b, c] = modes[state.mode].platform, [ox, oy, oz] = robot.origin;
    const [dx, dy, dz] = [x - ox, y - oy, z - oz];
    return [x + g * (u + b * dz - c * dy), y + g * (v + c * dx - a * dz), z + g * (w + a * dy - b * dx)];
  }

  const colour = (name) => getComputedStyle(root).getPropertyValue(name).trim() || "#777";
  function path(points, close = false) {
    pen.beginPath();
    points.forEach((point, i) => pen[i ? "lineTo" : "moveTo"](...screen(...point)));
    if (close) pen.closePath();
  }
  function stroke(style, lineWidth, alpha = 1) {
    Object.assign(pen, { strokeStyle: style, lineWidth, globalAlpha: alpha });
    pen.stroke();
    pen.globalAlpha = 1;
  }
  function cable(i, g) {
    const { stride } = modes[state.mode], count = (p - 1) / stride + 1, shape = shapes[state.mode];
    pen.beginPath();
    for (let j = 0; j < count; j++) {
      const a = 3 * (i * p + j * stride), b = 3 * (i * count + j), f = g / FULL;
      pen[j ? "lineTo" : "moveTo"](...screen(rest[a] + f * shape[b], rest[a + 1] + f * shape[b + 1], rest[a + 2] + f * shape[b + 2]));
    }
  }
  function axes(origin, directions, length, g, soft) {
    ["#d1433a", "#2a9152", "#4a7fd6"].forEach((style, i) => {
      const at = (r) => origin.map((v, j) => v + r * length * directions[i][j]);
      const [from, to] = [origin, at(1)].map((v) => (g === null ? v : carried(v, g)));
      path([from, to]);
      stroke(style, 2);
      if (!soft) return;
      const [a, b] = screen(...at(1.25));
      pen.fillStyle = style;
      pen.fillText("xyz"[i], a, b);
    });
  }
  function draw() {
    const [ink, soft, line, accent, orange] = ["--ink", "--soft", "--line", "--accent", "--mv-cable"].map(colour);
    const g = gain(), shares = modes[state.mode].energy.slice(1), most = Math.max(...shares, 1e-9);
    pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    pen.clearRect(0, 0, width, height);
    Object.assign(pen, { font: "12px sans-serif", textAlign: "center", textBaseline: "middle", lineJoin: "round", lineCap: "round" });
    const corner = (x, y) => [x ? high[0] : low[0], y ? high[1] : low[1], low[2]];
    path([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)], true);
    stroke(line, 1);
    pen.setLineDash([2, 4]);
    for (const anchor of robot.anchors) {
      path([anchor, [anchor[0], anchor[1], low[2]]]);
      stroke(soft, 1, 0.6);
    }
    pen.setLineDash([]);
    axes(corner(0, 0), [[1, 0, 0], [0, 1, 0], [0, 0, 1]], arrow, null, true);
    for (let i = 0; i < m; i++) (cable(i, 0), stroke(soft, 1, 0.6));
    for (const wheel of robot.wheels) (path(wheel), stroke(ink, 1.2));
    const body = robot.body.map((point) => carried(point, g));
    pen.fillStyle = accent;
    for (const corners of robot.triangles) {
      path(corners.map((i) => body[i]), true);
      pen.globalAlpha = 0.12;
      pen.fill();
    }
    for (const edge of robot.edges) (path(edge.map((point) => carried(point, g))), stroke(accent, 1.6));
    axes(robot.origin, robot.rotation, 0.6 * arrow, g, false);
    for (let i = 0; i < m; i++) (cable(i, g), stroke(orange, 1.2 + 1.6 * (shares[i] / most), 0.4 + 0.6 * (shares[i] / most)));
    const labels = [];
    robot.anchors.forEach((anchor, i) => {
      const [x, y] = screen(...anchor);
      pen.fillStyle = ink;
      pen.fillRect(x - 2.5, y - 2.5, 5, 5);
      const near = labels.find((label) => Math.hypot(label.x - x, label.y - y) < 16);
      if (near) near.text += `, ${i + 1}`;
      else labels.push({ x, y, text: `${i + 1}` });
    });
    for (const { x, y, text } of labels) {
      const half = 0.5 * pen.measureText(text).width + 2;
      pen.fillText(text, Math.min(Math.max(x, half), width - half), y - 12);
    }
  }

  const percent = (v) => `${(100 * v).toFixed(1)} %`;
  function tell() {
    const { hertz, kind, words, energy } = modes[state.mode], moved = 0.01 * state.amplitude * size;
    inside(".mv-caption").textContent = `Mode ${state.mode + 1} of ${modes.length}: ${hertz.toPrecision(5)} Hz, kind: ${kind}; platform: ${words}`;
    inside(".mv-scale").textContent =
      `Drawn so that the point that moves most moves ${moved.toPrecision(2)} m to each side. A mode shape has no size of its own; real ` +
      `vibrations are far smaller, and one cycle takes ${(1 / hertz).toPrecision(2)} s instead of ${CYCLE} s. Grey: at rest. Axes of the frame: ${arrow} m long.`;
    inside(".mv-energy").replaceChildren(...energy.map((share, i) => {
      const row = document.createElement("div"), [name, bar, value] = ["span", "i", "span"].map((tag) => document.createElement(tag));
      name.textContent = i ? `cable ${i}` : "platform";
      bar.append(document.createElement("b"));
      bar.firstChild.style.width = `${100 * Math.max(0, Math.min(1, share))}%`;
      value.textContent = percent(share);
      row.append(name, bar, value);
      return row;
    }));
    inside(".mv-play").textContent = state.playing ? "Pause" : "Play";
    inside(".mv-mode").value = state.mode + 1;
    again();
  }
  function again() {
    width = canvas.clientWidth;
    height = Math.round(width < 600 ? 0.8 * width : Math.min(0.56 * width, 600));
    canvas.style.height = `${height}px`;
    canvas.width = Math.round(width * devicePixelRatio);
    canvas.height = Math.round(height * devicePixelRatio);
    fit();
    draw();
  }
  let before = performance.now();
  function step(now) {
    if (state.playing) state.phase += (2 * Math.PI * Math.min(now - before, 100)) / 1000 / CYCLE;
    before = now;
    if (state.playing && state.seen && width) draw();
    requestAnimationFrame(step);
  }

  const change = (changes) => (Object.assign(state, changes), tell());
  inside(".mv-play").onclick = () => change({ playing: !state.playing });
  inside(".mv-mode").oninput = (event) => change({ mode: event.target.value - 1 });
  inside(".mv-amplitude").oninput = (event) => change({ amplitude: Number(event.target.value) });
  for (const button of root.querySelectorAll("[data-step]"))
    button.onclick = () => change({ mode: (state.mode + Number(button.dataset.step) + modes.length) % modes.length });
  for (const button of root.querySelectorAll("[data-view]"))
    button.onclick = () => change(Object.fromEntries(button.dataset.view.split(",").map((v, i) => [["yaw", "pitch"][i], Number(v)])));
  const fingers = new Map(), apart = () => Math.hypot(...[0, 1].map((i) => [...fingers.values()].reduce((a, v) => v[i] - a, 0)));
  canvas.onpointerdown = (event) => (fingers.set(event.pointerId, [event.clientX, event.clientY]), canvas.setPointerCapture(event.pointerId));
  canvas.onpointerup = canvas.onpointercancel = (event) => fingers.delete(event.pointerId);
  canvas.onpointermove = (event) => {
    const old = fingers.get(event.pointerId), span = apart();
    if (!old) return;
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (fingers.size > 1) state.zoom = Math.min(Math.max((state.zoom * apart()) / span, 0.3), 20);
    else Object.assign(state, { yaw: state.yaw - 0.4 * (event.clientX - old[0]), pitch: Math.min(Math.max(state.pitch + 0.4 * (event.clientY - old[1]), -90), 90) });
    fit();
    draw();
  };
  canvas.addEventListener("wheel", (event) => {
    if (document.activeElement !== canvas && !event.ctrlKey) return; // the page scrolls until the picture is clicked
    event.preventDefault();
    state.zoom = Math.min(Math.max(state.zoom * 2 ** (-event.deltaY / 400), 0.3), 20);
    fit();
    draw();
  }, { passive: false });
  canvas.ondblclick = () => change({ yaw: 28, pitch: 20, zoom: 1 });
  new ResizeObserver(again).observe(root);
  new IntersectionObserver(([entry]) => (state.seen = entry.isIntersecting)).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  tell();
  requestAnimationFrame(step);
})();
