// The pictures of a robot's cameras. Each is a page of its own, which may load this camera's addresses and nothing else.
import { TOKEN } from "#js/connection.js";
import { model } from "#js/model.js";
import { isRecorded } from "#js/recorded.js";
import { Live, html } from "#js/view.js";

export const CAMERAS = "nt:/CameraPublisher/";
const STREAMS = "/streams";

export class CamerasPanel extends Live {
  parts = ["paths", "hello", "connection"];

  render() {
    const names = cameraNames();
    return html`<div class="cameras fill">
      ${names.map((name) => html`<${Camera} key=${name} name=${name} />`)}
      ${!names.length && html`<p class="empty">The robot has published no camera.</p>`}
    </div>`;
  }
}

export function cameraNames() {
  const paths = [...model.values.keys()].filter((path) => path.startsWith(CAMERAS) && path.endsWith(STREAMS));
  return paths.map((path) => path.slice(CAMERAS.length, -STREAMS.length)).sort();
}

export function Camera({ name }) {
  if (isRecorded) return html`<p class="empty">Pictures are not recorded.</p>`;
  const query = new URLSearchParams({ token: TOKEN, name });
  return html`<figure class="camera column"><figcaption>${name}</figcaption><iframe title=${`Camera ${name}`} src=${`/camera?${query}`}></iframe></figure>`;
}
