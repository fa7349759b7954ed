// What modules of the page need of a browser when they are imported, and frames that a test draws itself.
const frames = [];

Object.assign(globalThis, {
  requestAnimationFrame: (draw) => frames.push(draw),
  addEventListener() {},
  matchMedia: () => ({ matches: false, addEventListener() {} }),
  location: { search: "", protocol: "http:", host: "localhost" },
  document: { getElementById: () => null, documentElement: { dataset: {} } },
});

// Draw the next frame, and return how many functions were waiting for it.
export function drawFrame() {
  const waiting = frames.splice(0);
  for (const draw of waiting) draw();
  return waiting.length;
}
