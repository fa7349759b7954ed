// The page of one camera: says so where no picture comes.
const image = document.querySelector("img");
const note = document.querySelector("p");
const RETRY = 3000; // milliseconds
const addresses = image.dataset.addresses.split(" ");
let tried = 0;

// A stream of pictures is loaded when its first one is there, and has an error when it ends.
image.addEventListener("load", () => show(true));
image.addEventListener("error", () => {
  show(false);
  tried += 1;
  setTimeout(load, tried % addresses.length ? 0 : RETRY);
});

function show(isThere) {
  image.hidden = !isThere;
  note.hidden = isThere;
}

function load() {
  const address = addresses[tried % addresses.length];
  image.src = tried < addresses.length ? address : `${address}${address.includes("?") ? "&" : "?"}again=${tried}`;
}

// The colours are those of the page around it.
const page = parent.document.documentElement;
const takeColours = () => {
  document.documentElement.dataset.theme = page.dataset.theme ?? "";
};
new MutationObserver(takeColours).observe(page, { attributeFilter: ["data-theme"] });
takeColours();
if (addresses[0]) load();
else show(false);
