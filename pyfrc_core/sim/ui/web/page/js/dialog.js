// A question with one line of text as the answer.

// Ask for a text; the promise has it, or null if the person gave up.
export function askText(question, text) {
  const dialog = document.createElement("dialog");
  const form = document.createElement("form");
  form.method = "dialog";
  const label = document.createElement("label");
  label.textContent = question;
  const box = document.createElement("input");
  box.type = "text";
  box.value = text;
  const buttons = document.createElement("div");
  buttons.className = "dialog-buttons";
  const cancel = button("Cancel", "cancel");
  const accept = button("OK", "ok");
  accept.className = "primary";
  buttons.append(cancel, accept);
  label.append(box);
  form.append(label, buttons);
  dialog.append(form);
  document.body.append(dialog);
  // Enter accepts, whichever button comes first.
  box.addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    dialog.close("ok");
  });
  cancel.type = "button";
  cancel.addEventListener("click", () => dialog.close("cancel"));
  dialog.showModal();
  box.select();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      const answer = dialog.returnValue === "ok" ? box.value.trim() : "";
      dialog.remove();
      resolve(answer || null);
    });
  });
}

function button(text, value) {
  const made = document.createElement("button");
  made.textContent = text;
  made.value = value;
  return made;
}
