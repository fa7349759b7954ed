// The pictures of a robot's cameras. Each is a page of its own, which may load this camera's addresses and nothing else.
import { TOKEN } from "#js/connection.js";
import { model } from "#js/model.js";
import { Live, html } from "#js/view.js";

const TABLE = "nt:/CameraPublisher/";
const STREAMS = "/streams";

export class CamerasPanel extends Live {
  parts = ["paths", "hello", "connection", "shown"]; // shown: the colours have changed

  render() {
    const names = [...model.values.keys()].filter((path) => path.startsWith(TABLE) && path.endsWith(STREAMS)).map((path) => path.slice(TABLE.length, -STREAMS.length));
    return html`<div class="cameras">
      ${names.sort().map((name) => html`<${Camera} key=${name} name=${name} />`)}
      ${!names.length && html`<p class="empty">The robot has published no camera.</p>`}
    </div>`;
  }
}

export function Camera({ name }) {
  const query = new URLSearchParams({ token: TOKEN, name, theme: document.documentElement.dataset.theme ?? "" });
  return html`<figure class="camera"><figcaption>${name}</figcaption><iframe title=${`Camera ${name}`} src=${`/camera?${query}`}></iframe></figure>`;
}
