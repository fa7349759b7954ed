// The wheel over a chart or the field zooms. Where something around it scrolls, the wheel scrolls that, as it does beside
// the chart, and zooms with Ctrl: as on maps in web pages. Two fingers on a trackpad come as a wheel, too: sideways they
// move, and apart (a pinch) the browser sends Ctrl with them.

const ZOOM = 0.0015; // the logarithm of the factor for each pixel that the wheel would scroll
const PINCH = 10; // a pinch comes in steps of a few pixels
const MOST = 150; // pixels of one step with Ctrl, so that a real wheel does not zoom ten times as fast
const HINT_TIME = 1800; // milliseconds

// What the wheel does over an element: zoom(factor, event), with a factor below 1 to see less; and move(pixels) sideways.
export function onWheel(element, { zoom, move = null }) {
  element.addEventListener("wheel", (event) => {
    const { deltaX, deltaY } = event;
    const withKey = event.ctrlKey || event.metaKey;
    if (!withKey && move && Math.abs(deltaX) > Math.abs(deltaY)) {
      if (scrolls(element, "X", "Width")) return;
      event.preventDefault();
      move(deltaX);
    } else if (withKey || !scrolls(element, "Y", "Height")) {
      event.preventDefault();
      const pixels = withKey ? Math.max(-MOST, Math.min(MOST, PINCH * deltaY)) : deltaY;
      if (pixels) zoom(Math.exp(pixels * ZOOM), event);
    } else showHint(element);
  }, { passive: false });
}

// Whether something around an element has more than it can show.
function scrolls(element, axis, size) {
  for (let outer = element.parentElement; outer; outer = outer.parentElement) {
    if (outer[`scroll${size}`] <= outer[`client${size}`] + 1) continue;
    if (["auto", "scroll"].includes(getComputedStyle(outer)[`overflow${axis}`])) return true;
  }
  return false;
}

let hint = null;
let timer = null;

function showHint(element) {
  if (!hint) {
    hint = document.createElement("div");
    hint.className = "wheel-hint";
    hint.role = "status";
    hint.popover = "manual";
    hint.textContent = `${/Mac/.test(navigator.platform) ? "⌘" : "Ctrl"} and the wheel, or a pinch, zoom here`;
    document.body.append(hint);
  }
  hint.showPopover(); // above everything, also in full screen
  const box = element.getBoundingClientRect();
  hint.style.left = `${box.left + (box.width - hint.offsetWidth) / 2}px`;
  hint.style.top = `${Math.max(box.top, 0) + 6}px`;
  clearTimeout(timer);
  timer = setTimeout(() => hint.hidePopover(), HINT_TIME);
}
