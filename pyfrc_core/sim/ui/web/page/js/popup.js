// Lists that open beside a button, above everything else on the page.

const GAP = 5; // pixels between the button and its list

// Show an element with popover="manual" below an anchor, or above it where there is more space.
export function showBeside(popup, anchor) {
  if (!popup.matches(":popover-open")) popup.showPopover();
  const box = anchor.getBoundingClientRect();
  const { width } = popup.getBoundingClientRect();
  const below = innerHeight - box.bottom - 2 * GAP;
  const above = box.top - 2 * GAP;
  const up = below < Math.min(popup.scrollHeight, 320) && above > below;
  popup.style.maxHeight = `${up ? above : below}px`;
  popup.style.left = `${Math.max(Math.min(box.right - width, innerWidth - width - GAP), GAP)}px`;
  popup.style.top = up ? "auto" : `${box.bottom + GAP}px`;
  popup.style.bottom = up ? `${innerHeight - box.top + GAP}px` : "auto";
}
