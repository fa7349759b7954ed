// Logs that a person drops on the page, or chooses: the server opens them, and they become branches.
import { TOKEN } from "#js/connection.js";
import { model } from "#js/model.js";
import { isRecorded } from "#js/recorded.js";

async function open(file) {
  if (isRecorded) return model.set("problem", "This page is one file, without pyfrc: pyfrc view opens logs.");
  if (model.readonly) return model.set("problem", "This window only shows: it cannot open logs.");
  model.set("problem", `Reading ${file.name}…`);
  try {
    const address = `/log?${new URLSearchParams({ token: TOKEN, name: file.name })}`;
    const answer = await fetch(address, { method: "POST", body: file });
    const { branch, text } = await answer.json();
    model.set("problem", text);
    if (branch !== undefined) model.set("compared", branch);
  } catch {
    model.set("problem", `${file.name} could not be sent to pyfrc.`);
  }
}

async function openAll(files) {
  for (const file of files) await open(file);
}

// Have the person choose logs.
export function chooseLog() {
  const input = Object.assign(document.createElement("input"), { type: "file", multiple: true });
  input.onchange = () => openAll(input.files);
  input.click();
}

const hasFiles = (event) => event.dataTransfer?.types.includes("Files");

export function startDrops() {
  const mark = (isOver) => document.body.classList.toggle("drops", isOver);
  document.addEventListener("dragover", (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    mark(true);
  });
  document.addEventListener("dragleave", (event) => event.relatedTarget === null && mark(false));
  document.addEventListener("drop", (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    mark(false);
    openAll(event.dataTransfer.files);
  });
}
