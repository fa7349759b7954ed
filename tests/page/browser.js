// What modules of the page need of a browser when they are imported, frames that a test draws itself, and a server.
const frames = [];

Object.assign(globalThis, {
  requestAnimationFrame: (draw) => frames.push(draw),
  addEventListener() {},
  ResizeObserver: class {},
  matchMedia: () => ({ matches: false, addEventListener() {} }),
  location: { search: "", protocol: "http:", host: "localhost" },
  sessionStorage: { getItem: () => null, setItem() {}, removeItem() {} },
  document: { getElementById: () => null, querySelector: () => null, documentElement: { dataset: {} } },
  innerWidth: 1366,
  innerHeight: 768,
});

// Draw the next frame, and return how many functions were waiting for it.
export function drawFrame() {
  const waiting = frames.splice(0);
  for (const draw of waiting) draw(0);
  return waiting.length;
}

// Let the page connect to a server that answers with the time as a value. Returns what was sent to it.
export function serve() {
  const sent = [];
  globalThis.WebSocket = class {
    static OPEN = 1;
    readyState = 1;

    constructor() {
      queueMicrotask(() => this.onopen());
    }

    send(text) {
      const message = JSON.parse(text);
      sent.push(message);
      queueMicrotask(() => this.onmessage({ data: JSON.stringify({ type: "answer", id: message.id, t: message.t, values: { t: message.t }, series: {} }) }));
    }
  };
  globalThis.setInterval = () => 0; // the connection's ticks
  return sent;
}

// All elements and components that were rendered, without what components render in their turn.
export function elements(node) {
  if (Array.isArray(node)) return node.flatMap(elements);
  if (!node?.props) return [];
  return [node, ...elements(node.props.children ?? [])];
}
