// The page's half of pinhole.View. It shows the kernel's pictures, and tells the kernel how pointers and keys move.

/** A pointer that moves less than this, in CSS pixels, clicks. */
const CLICK = 4;

/** How long the page waits for a picture before it tells the kernel more, in milliseconds. */
const PATIENCE = 400;

/** How long after the last step of the wheel or key the camera is still, in milliseconds. */
const STILL_AFTER = 250;

/** What the keys do: turns and moves in parts of the picture's height, zoom in CSS pixels of a wheel. */
const KEYS = {
  ArrowLeft: [-0.04, 0],
  ArrowRight: [0.04, 0],
  ArrowUp: [0, -0.04],
  ArrowDown: [0, 0.04],
};
const ZOOM_KEYS = { "+": 60, "=": 60, "-": -60 };

function render({ model, el }) {
  const frame = document.createElement("div");
  frame.className = "pinhole-view";
  frame.tabIndex = 0;
  frame.setAttribute("role", "application");
  const image = document.createElement("img");
  image.draggable = false;
  const label = document.createElement("span");
  label.className = "pinhole-label";
  label.setAttribute("aria-live", "polite");
  const status = document.createElement("span");
  status.className = "pinhole-status";
  frame.append(image, label, status);
  el.append(frame);

  // Pictures. The kernel has more pixels for screens that have more; the size on the page stays.
  let url = null;
  let newest = 0;
  async function showPicture() {
    const bytes = model.get("_picture");
    waitsSince = 0;
    if (pending) schedule();
    if (!bytes || !bytes.byteLength) return;
    const number = ++newest;
    const next = URL.createObjectURL(new Blob([bytes], { type: "image/png" }));
    const decoded = new Image();
    decoded.src = next;
    try {
      await decoded.decode();
    } catch {
      URL.revokeObjectURL(next);
      return;
    }
    if (number !== newest) {
      URL.revokeObjectURL(next);
      return;
    }
    image.src = next;
    if (url) URL.revokeObjectURL(url);
    url = next;
  }
  function showSize() {
    const [width, height] = model.get("_size");
    image.width = width;
    image.style.aspectRatio = `${width} / ${height}`;
  }
  function showTexts() {
    label.textContent = model.get("_label");
    status.textContent = model.get("_status");
    image.alt = model.get("_name");
    frame.setAttribute("aria-label", model.get("_name"));
  }

  // Movements are added up until the kernel has answered the last ones.
  let pending = null;
  let waitsSince = 0;
  let scheduled = false;
  let timer = 0;
  function move(change) {
    pending ??= { turn: [0, 0], pan: [0, 0], zoom: 0, roll: 0 };
    for (const key of ["turn", "pan"]) {
      if (change[key]) pending[key] = pending[key].map((old, axis) => old + change[key][axis]);
    }
    pending.zoom += change.zoom ?? 0;
    pending.roll += change.roll ?? 0;
    schedule();
  }
  function schedule() {
    if (scheduled) return;
    scheduled = true;
    const left = waitsSince ? waitsSince + PATIENCE - performance.now() : 0;
    clearTimeout(timer);
    if (left > 0) {
      // A picture that arrives before comes first.
      scheduled = false;
      timer = setTimeout(flush, left);
    } else {
      requestAnimationFrame(flush);
    }
  }
  function flush() {
    scheduled = false;
    clearTimeout(timer);
    if (!pending) return;
    model.send({ kind: "move", ...pending });
    pending = null;
    waitsSince = performance.now();
  }
  function still() {
    flush();
    model.send({ kind: "still" });
  }
  let stillTimer = 0;
  function stillSoon() {
    clearTimeout(stillTimer);
    stillTimer = setTimeout(still, STILL_AFTER);
  }

  // Pointers: one turns, two of a touch screen move and zoom.
  const pointers = new Map();
  let start = null;
  let moved = false;
  function place(event) {
    const box = image.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  }
  function gesture() {
    const [a, b] = [...pointers.values()];
    return { x: (a[0] + b[0]) / 2, y: (a[1] + b[1]) / 2, apart: Math.hypot(a[0] - b[0], a[1] - b[1]) };
  }
  function down(event) {
    if (event.button > 2) return;
    frame.focus({ preventScroll: true });
    image.setPointerCapture(event.pointerId);
    if (pointers.size === 0) {
      moved = false;
      start = [event.clientX, event.clientY];
    }
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (pointers.size > 1) moved = true;
    event.preventDefault();
  }
  function drag(event) {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    if (!moved && Math.hypot(now[0] - start[0], now[1] - start[1]) < CLICK) return;
    moved = true;
    frame.classList.add("pinhole-moves");
    const height = image.getBoundingClientRect().height || 1;
    const old = pointers.size === 2 ? gesture() : null;
    pointers.set(event.pointerId, now);
    const by = [(now[0] - before[0]) / height, (now[1] - before[1]) / height];
    if (old) {
      const next = gesture();
      const zoom = old.apart > 0 && next.apart > 0 ? Math.log(next.apart / old.apart) / 0.003 : 0;
      move({ pan: [(next.x - old.x) / height, (next.y - old.y) / height], zoom });
    } else if (pointers.size === 1) {
      if (event.ctrlKey) move({ roll: 2 * by[0] });
      else if (event.shiftKey || (event.buttons & 6) !== 0) move({ pan: by });
      else move({ turn: by });
    }
  }
  function up(event) {
    if (!pointers.delete(event.pointerId) || pointers.size > 0) return;
    frame.classList.remove("pinhole-moves");
    if (moved) still();
    else if (event.type === "pointerup" && event.button === 0) model.send({ kind: "pick", at: place(event) });
  }
  function wheel(event) {
    event.preventDefault();
    const unit = event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1;
    move({ zoom: -event.deltaY * unit });
    stillSoon();
  }
  function reset() {
    pending = null;
    model.send({ kind: "reset" });
  }
  function key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (KEYS[event.key]) {
      move(event.shiftKey ? { pan: KEYS[event.key] } : { turn: KEYS[event.key] });
      stillSoon();
    } else if (ZOOM_KEYS[event.key]) {
      move({ zoom: ZOOM_KEYS[event.key] });
      stillSoon();
    } else if (event.key === "Home") reset();
    else if (event.key === "Enter") model.send({ kind: "pick", at: [0.5, 0.5] });
    else if (event.key === "Escape") model.send({ kind: "unpick" });
    else return;
    // The notebook has keys of its own.
    event.preventDefault();
    event.stopPropagation();
  }

  // The screen: pictures have its pixels, also after the window was moved to another one.
  let query = null;
  function screen() {
    query?.removeEventListener("change", screen);
    query = window.matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`);
    query.addEventListener("change", screen);
    model.send({ kind: "screen", ratio: window.devicePixelRatio });
  }

  image.addEventListener("pointerdown", down);
  image.addEventListener("pointermove", drag);
  image.addEventListener("pointerup", up);
  image.addEventListener("pointercancel", up);
  image.addEventListener("wheel", wheel, { passive: false });
  image.addEventListener("dblclick", reset);
  image.addEventListener("contextmenu", (event) => event.preventDefault());
  frame.addEventListener("keydown", key);
  model.on("change:_picture", showPicture);
  model.on("change:_size", showSize);
  for (const name of ["_label", "_status", "_name"]) model.on(`change:${name}`, showTexts);
  showSize();
  showTexts();
  showPicture();
  screen();

  return () => {
    model.off("change:_picture", showPicture);
    model.off("change:_size", showSize);
    for (const name of ["_label", "_status", "_name"]) model.off(`change:${name}`, showTexts);
    query?.removeEventListener("change", screen);
    clearTimeout(timer);
    clearTimeout(stillTimer);
    if (url) URL.revokeObjectURL(url);
  };
}

export default { render };
