// Runs the page's half of the view with a model and a page that are made here, and prints what it sends as JSON.
// node view_page.mjs FILE

import { pathToFileURL } from "node:url";

class Element extends EventTarget {
  constructor(name) {
    super();
    Object.assign(this, { name, children: [], style: {}, attributes: {}, classes: new Set(), textContent: "" });
    this.classList = { add: (of) => this.classes.add(of), remove: (of) => this.classes.delete(of) };
  }
  setAttribute(key, of) { this.attributes[key] = of; }
  append(...of) { this.children.push(...of); }
  getBoundingClientRect() { return { left: 10, top: 20, width: 320, height: 240 }; }
  setPointerCapture() {}
  focus() { this.isFocused = true; }
}

let frames = [];
let now = 1000;
const urls = new Set();
Object.assign(globalThis, {
  document: { createElement: (name) => new Element(name) },
  window: { devicePixelRatio: 2, matchMedia: () => new EventTarget() },
  requestAnimationFrame: (call) => frames.push(call),
  Image: class { async decode() { if (this.src === "broken") throw new Error(); } },
});
globalThis.performance.now = () => now;
let made = 0;
URL.createObjectURL = () => { const url = `blob:${++made}`; urls.add(url); return url; };
URL.revokeObjectURL = (url) => urls.delete(url);

const sent = [];
const model = {
  state: { _picture: new DataView(new ArrayBuffer(8)), _size: [320, 240], _label: "", _status: "", _name: "picture of 3 spheres" },
  calls: new Map(),
  get(name) { return this.state[name]; },
  set(name, of) { this.state[name] = of; for (const call of this.calls.get(`change:${name}`) ?? []) call(); },
  on(name, call) { this.calls.set(name, [...(this.calls.get(name) ?? []), call]); },
  off(name, call) { this.calls.set(name, (this.calls.get(name) ?? []).filter((of) => of !== call)); },
  send(message) { sent.push(structuredClone(message)); },
};
const steps = {};
let last = 0;
function note(name) { steps[name] = sent.slice(last); last = sent.length; }
function frame() { const calls = frames; frames = []; for (const call of calls) call(); }
const tick = () => new Promise((done) => setTimeout(done, 5));
function event(target, type, of = {}) {
  const made = Object.assign(new Event(type, { cancelable: true }), { pointerId: 1, button: 0, buttons: 1, clientX: 0, clientY: 0, ...of });
  target.dispatchEvent(made);
  return made.defaultPrevented;
}

const { default: widget } = await import(pathToFileURL(process.argv[2]));
const root = new Element("root");
const cleanup = widget.render({ model, el: root });
const box = root.children[0];
const [image, label, status] = box.children;
await tick();
note("start");
const first = image.src;

event(image, "pointerdown", { clientX: 170, clientY: 140 });
event(image, "pointermove", { clientX: 171, clientY: 141 });
event(image, "pointerup", { clientX: 170, clientY: 140 });
note("click");

event(image, "pointerdown", { clientX: 100, clientY: 100 });
event(image, "pointermove", { clientX: 112, clientY: 100 });
event(image, "pointermove", { clientX: 124, clientY: 124 });
frame();
note("drag");
// Until a picture arrives, movements are added up.
event(image, "pointermove", { clientX: 136, clientY: 124 });
frame();
event(image, "pointermove", { clientX: 148, clientY: 124 });
frame();
note("without an answer");
model.set("_picture", new DataView(new ArrayBuffer(9)));
frame();
note("with an answer");
event(image, "pointerup", { clientX: 148, clientY: 124 });
note("release");

event(image, "pointerdown", { clientX: 100, clientY: 100, shiftKey: true });
event(image, "pointermove", { clientX: 124, clientY: 100, shiftKey: true });
event(image, "pointerup", { clientX: 124, clientY: 100 });
note("shift");
event(image, "pointerdown", { clientX: 100, clientY: 100, ctrlKey: true });
event(image, "pointermove", { clientX: 124, clientY: 100, ctrlKey: true });
event(image, "pointerup", { clientX: 124, clientY: 100 });
note("ctrl");

event(image, "pointerdown", { pointerId: 1, clientX: 100, clientY: 100 });
event(image, "pointerdown", { pointerId: 2, clientX: 200, clientY: 100 });
event(image, "pointermove", { pointerId: 2, clientX: 300, clientY: 100 });
event(image, "pointerup", { pointerId: 2 });
event(image, "pointerup", { pointerId: 1 });
note("pinch");

steps.wheelIsTaken = event(image, "wheel", { deltaY: 100, deltaMode: 0 });
now += 1000;
frame();
await new Promise((done) => setTimeout(done, 300));
note("wheel");
steps.keysAreTaken = ["ArrowLeft", "Enter", "Escape", "Home", "x"].map((key) => event(box, "keydown", { key }));
now += 1000;
frame();
note("keys");

model.set("_label", "sphere 7");
model.set("_status", "4 of 16 samples");
await tick();
Object.assign(steps, {
  label: label.textContent, status: status.textContent, tabIndex: box.tabIndex, name: box.attributes["aria-label"],
  width: image.width, isNew: image.src !== first, urls: urls.size,
});
cleanup();
steps.urlsAtTheEnd = urls.size;
steps.listenersAtTheEnd = [...model.calls.values()].flat().length;
clearTimeout();
console.log(JSON.stringify(steps));
process.exit(0);
