// A source line that opens in the editor. Only files of the project get a link.
import { model } from "#js/model.js";
import { html } from "#js/view.js";

export function SourceLink({ file, line }) {
  const text = line ? `${file}:${line}` : file;
  const root = model.hello?.project.root;
  if (!root || /^[a-z]+:/i.test(file) || file.startsWith("/") || file.startsWith("<")) return html`<span class="source">${text}</span>`;
  const place = `${root}/${file}`.split("/").map(encodeURIComponent).join("/");
  const address = `vscode://file${place.startsWith("/") ? "" : "/"}${place}${line ? `:${line}` : ""}`;
  return html`<a class="source" href=${address} title=${`Open ${text} in the editor`}>${text}</a>`;
}
