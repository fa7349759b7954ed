// Whether the page shows the present: { text, kind }, with the kind "live", "lost" (it is expected back) or "over".
import { NO_CONNECTION } from "#js/gaps.js";
import { model } from "#js/model.js";

const ENDED = { text: "Ended", kind: "over" };
const LOST = { text: "No connection", kind: "lost" };

export function link() {
  const { connection, station, status } = model;
  if (connection === "closed" || (connection === "open" && status.state === "failed")) return ENDED;
  // The page has lost pyfrc, or pyfrc the robot.
  if (connection !== "open" || station.mode === NO_CONNECTION) return LOST;
  return { text: "Live", kind: "live" };
}

// What the robot is doing at the moment that is shown: { text, kind } as the station has them. Without a connection, it is
// not known.
export function robotState() {
  const { station } = model.shown;
  if (model.connection === "open" || model.past || model.isOver) return station;
  return { text: link().text, kind: "wait" };
}
