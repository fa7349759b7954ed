// The page of one camera: says so where no picture comes.
const note = document.querySelector("p");
const PATIENCE = 5000; // milliseconds until a picture has to be there, and until the next one is asked for
let image = document.querySelector("img");
const addresses = image.dataset.addresses.split(" ");
let asked = 0;
let failed = 0;

// Browsers do not say when a stream of pictures has ended, or stands still with its last one. So it is asked for again while
// it is shown, and what comes first then replaces it.
function load() {
  const address = addresses[failed % addresses.length];
  const next = new Image();
  next.alt = image.alt;
  const late = setTimeout(() => take(false), PATIENCE);
  const take = (isThere) => {
    clearTimeout(late);
    next.onload = next.onerror = null;
    image.removeAttribute("src"); // ends its stream
    image.replaceWith(next);
    image = next;
    image.hidden = !isThere;
    note.hidden = isThere;
    if (!isThere) {
      image.removeAttribute("src");
      failed += 1;
    }
    setTimeout(load, isThere || failed % addresses.length === 0 ? PATIENCE : 0);
  };
  next.onload = () => take(true);
  next.onerror = () => take(false);
  next.src = asked ? `${address}${address.includes("?") ? "&" : "?"}again=${asked}` : address;
  asked += 1;
}

// The colours are those of the page around it.
const page = parent.document.documentElement;
const takeColours = () => {
  document.documentElement.dataset.theme = page.dataset.theme ?? "";
};
new MutationObserver(takeColours).observe(page, { attributeFilter: ["data-theme"] });
takeColours();
if (addresses[0]) load();
else note.hidden = false;
