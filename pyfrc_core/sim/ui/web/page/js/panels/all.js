// Every panel that can be opened, by the part of its name before a colon. Those that only drive are of no use for a recorded run.
import { ConsolePanel } from "./console.js";
import { DevicesPanel } from "./devices.js";
import { FieldPanel } from "./field.js";
import { JoysticksPanel } from "./joysticks.js";
import { KeysPanel } from "./keys.js";
import { MatchPanel } from "./match.js";
import { MechanismPanel } from "./mechanism.js";
import { NetworkTablesPanel } from "./networktables.js";
import { PlotPanel } from "./plot.js";
import { TouchPanel } from "./touch.js";
import { WidgetsPanel } from "./widgets.js";

export const PANELS = {
  field: { title: "Field", component: FieldPanel },
  devices: { title: "Devices", component: DevicesPanel },
  plot: { title: "Plot", component: PlotPanel },
  networktables: { title: "NetworkTables", component: NetworkTablesPanel },
  widgets: { title: "Dashboard", component: WidgetsPanel },
  mechanism: { title: "Mechanism", component: MechanismPanel },
  console: { title: "Console", component: ConsolePanel },
  match: { title: "Match", component: MatchPanel },
  joysticks: { title: "Joysticks", component: JoysticksPanel },
  keys: { title: "Keys", component: KeysPanel, drives: true },
  touch: { title: "Touch sticks", component: TouchPanel, drives: true },
};

export function panelTitle(panel) {
  const [kind, number] = (panel ?? "").split(":");
  const title = PANELS[kind]?.title ?? kind;
  return number ? `${title} ${number}` : title;
}
