// A question, with one line of text or a button as the answer. The browser's own dialogs would stop the page: it would
// no longer read what the server sends, and count as gone.
import { html, render } from "#js/view.js";

// Ask for a text; the promise has it, or null if the person gave up.
export async function askText(question, text) {
  const dialog = await ask(html`${question}<input type="text" value=${text} />`, "OK");
  return (dialog.returnValue === "ok" && dialog.querySelector("input").value.trim()) || null;
}

// Ask whether to do something; the promise is true for the button with this text.
export async function askWhether(question, yes) {
  return (await ask(question, yes)).returnValue === "ok";
}

// The promise has the dialog when it is closed. Enter accepts: the other button submits nothing.
/** @returns {Promise<HTMLDialogElement>} */
function ask(question, yes) {
  const dialog = document.createElement("dialog");
  render(html`<form method="dialog"><label>${question}</label><div class="dialog-buttons">
    <button type="button" onClick=${() => dialog.close("cancel")}>Cancel</button><button class="primary" value="ok">${yes}</button></div></form>`, dialog);
  document.body.append(dialog);
  dialog.showModal();
  dialog.querySelector("input")?.select();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(dialog);
    });
  });
}
