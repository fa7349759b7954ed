// A question, with one line of text or a button as the answer. The browser's own dialogs would stop the page: it would
// no longer read what the server sends, and count as gone.

// Ask for a text; the promise has it, or null if the person gave up.
export async function askText(question, text) {
  const box = document.createElement("input");
  box.type = "text";
  box.value = text;
  const agreed = await ask(question, "OK", box);
  return (agreed && box.value.trim()) || null;
}

// Ask whether to do something; the promise is true for the button with this text.
export function askWhether(question, yes) {
  return ask(question, yes, null);
}

function ask(question, yes, box) {
  const dialog = document.createElement("dialog");
  const form = document.createElement("form");
  form.method = "dialog";
  const label = document.createElement("label");
  label.textContent = question;
  const buttons = document.createElement("div");
  buttons.className = "dialog-buttons";
  const cancel = button("Cancel", "cancel");
  const accept = button(yes, "ok");
  accept.className = "primary";
  buttons.append(cancel, accept);
  if (box) label.append(box);
  form.append(label, buttons);
  dialog.append(form);
  document.body.append(dialog);
  // Enter accepts, whichever button comes first.
  box?.addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    dialog.close("ok");
  });
  cancel.type = "button";
  cancel.addEventListener("click", () => dialog.close("cancel"));
  dialog.showModal();
  box?.select();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(dialog.returnValue === "ok");
    });
  });
}

function button(text, value) {
  const made = document.createElement("button");
  made.textContent = text;
  made.value = value;
  return made;
}
