// The keys that go to another moment: on the timeline; and, where nothing is driven, wherever they do nothing else.
import { model } from "#js/model.js";
import { live, look, lookBy, lookByPackets } from "#js/past.js";
import { playback } from "#js/playback.js";

const USES_KEYS = 'input, select, textarea, [contenteditable], [role="tab"], [tabindex="0"]:not([role="log"]):is([role], :focus-visible), .menu, dialog';
const SCROLL = ["PageUp", "PageDown", "Home", "End"];

// Do what a key does, and return whether it does something.
export function lookByKey(event) {
  if (event.ctrlKey || event.altKey || event.metaKey) return false;
  const far = event.shiftKey ? 50 : 1;
  const acts = {
    ArrowLeft: () => lookByPackets(-far),
    ArrowRight: () => lookByPackets(far),
    PageDown: () => lookBy(-1),
    PageUp: () => lookBy(1),
    Home: () => look(0),
    End: live,
  };
  if (!acts[event.key]) return false;
  event.preventDefault();
  playback.pause();
  acts[event.key]();
  return true;
}

// Look at a moment that a person has chosen; after a click, the keys go on from there.
export function goTo(t) {
  look(t);
  const timeline = /** @type {HTMLElement | null} */ (document.querySelector(".timeline"));
  if (!document.querySelector(":focus-visible")) timeline?.focus();
}

export function startMomentKeys() {
  document.addEventListener("keydown", (/** @type {any} */ event) => {
    if (!model.hello || model.isDriven || event.defaultPrevented || event.target.closest?.(USES_KEYS)) return;
    if (SCROLL.includes(event.key) && event.target.closest?.('[role="log"]')) return; // its lines
    lookByKey(event);
  });
}
