// The WebSocket to `pyfrc sim`. It connects again by itself; each connection begins with the whole state.
// A page with a recorded run in it asks that run instead.
import { model } from "#js/model.js";
import { isRecorded, readRun } from "#js/recorded.js";

export const TOKEN = new URLSearchParams(location.search).get("token") ?? "";

const WAITS = [200, 400, 800, 1500]; // milliseconds between attempts to connect

// A computer that has slept, a network that is gone or a server that hangs closes no connection: the page notices the
// silence. It counts its own ticks, which stop while the page itself sleeps.
const TICK = 1000; // milliseconds
const ASK_AFTER = 2; // ticks of silence, after which the page asks whether the server is there
const LOST_AFTER = 6; // ticks of silence, after which it connects again

// Why a question has no answer. What the page keeps by itself is sent again with the next connection.
export class Disconnected extends Error {}

let run = null; // the recorded run
let socket = null;
let attempts = 0;
let silence = 0;
let finished = false;
let nextId = 1;
const requests = new Map(); // id: { resolve, reject }
let onMessage = (_message) => {};
let onState = (_state) => {};

// Connect, and call `message` with each message of the server, `state` with "open", "lost", "refused" or "closed".
export function connect(message, state) {
  onMessage = message;
  onState = state;
  if (isRecorded) return openRun();
  model.listen((changed) => changed.has("needs") && ask("show", model.needs).catch(() => {}));
  open();
  setInterval(tick, TICK);
}

function tick() {
  if (finished || socket === null) return;
  silence += 1;
  if (silence === ASK_AFTER) send({ type: "ping", id: nextId++ });
  if (silence < LOST_AFTER) return;
  const silent = socket;
  silent.onmessage = silent.onopen = silent.onclose = null;
  silent.close();
  lost();
}

async function openRun() {
  try {
    run = await readRun();
  } catch (error) {
    console.error(error);
    return onState("unreadable");
  }
  onState("open");
  onMessage(run.hello);
}

function open() {
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  socket = new WebSocket(`${scheme}://${location.host}/ws?token=${encodeURIComponent(TOKEN)}`);
  silence = 0;
  socket.onmessage = (event) => {
    silence = 0;
    receive(JSON.parse(event.data));
  };
  socket.onopen = () => {
    attempts = 0;
    onState("open");
  };
  socket.onclose = lost;
}

function lost() {
  socket = null;
  for (const request of requests.values()) request.reject(new Disconnected("The connection was lost. What you did last may not have been carried out."));
  requests.clear();
  if (finished) return;
  if (attempts) checkAddress();
  onState("lost");
  setTimeout(open, WAITS[Math.min(attempts, WAITS.length - 1)]);
  attempts += 1;
}

// Another `pyfrc sim` at the same port does not know the key of this address.
async function checkAddress() {
  const answer = await fetch(`/?token=${encodeURIComponent(TOKEN)}`).catch(() => null);
  if (answer?.status !== 403) return;
  finished = true;
  onState("refused");
}

function receive(message) {
  if (message.type === "answer" || message.type === "error") {
    const request = requests.get(message.id);
    requests.delete(message.id);
    if (message.type === "answer") request?.resolve(message);
    else if (request) request.reject(new Error(message.message));
    else onMessage({ type: "problem", text: message.message });
    return;
  }
  if (message.type === "working") return; // it ends the silence
  if (message.type === "closed") {
    finished = true;
    onState("closed");
    return;
  }
  onMessage(message);
}

function send(message) {
  if (socket?.readyState !== WebSocket.OPEN) return false;
  socket.send(JSON.stringify(message));
  return true;
}

/**
 * Ask the server; the promise has its answer.
 * @param {string} type
 * @returns {Promise<any>}
 */
export function ask(type, fields = {}) {
  if (run) return run.answer(type, fields);
  const id = nextId++;
  return new Promise((resolve, reject) => {
    if (!send({ ...fields, type, id })) return reject(new Disconnected("There is no connection. What you did last was not carried out."));
    requests.set(id, { resolve, reject });
  });
}

// What moves the robot. While the panels show the past, no one would see it: it is refused, except that it lets go.
const MOVES = new Set(["enable", "practice", "write", "button", "pov", "plug", "place", "reset_position"]);

export function refusedInPast() {
  if (!model.past) return false;
  onMessage({ type: "problem", text: "The panels show the past. Choose “Live” to drive the robot, or “Drive on from here”." });
  model.announce("shown"); // a switch that was clicked goes back
  return true;
}

function letsGo(name, { pressed, angle, values }) {
  if (name === "button") return !pressed;
  if (name === "pov") return angle === -1;
  return name === "write" && Object.entries(values).every(([target, value]) => target.startsWith("joysticks[") && value === atRest(target));
}

// The value of an axis, a button or a POV that is not touched.
export function atRest(target) {
  if (target.includes(".axes[")) return 0;
  return target.includes(".povs[") ? -1 : false;
}

/**
 * Carry out a command, such as command("speed", { factor: 0.5 }). A failure is shown to the user.
 * @param {string} name
 * @param {any} fields
 */
export function command(name, fields = {}) {
  if (MOVES.has(name) && !letsGo(name, fields) && refusedInPast()) return Promise.resolve();
  return ask("command", { ...fields, name }).catch((error) => onMessage({ type: "problem", text: error.message }));
}

// Change inputs: write({ "dio[3].value": true }).
export function write(values) {
  return command("write", { values });
}
