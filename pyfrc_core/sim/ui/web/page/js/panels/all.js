// Every panel that can be opened, by the part of its name before a colon. Those that only drive are of no use for a recorded run.
import { CamerasPanel } from "#js/panels/cameras.js";
import { ChangesPanel } from "#js/panels/changes.js";
import { ConsolePanel } from "#js/panels/console.js";
import { DashboardPanel } from "#js/panels/dashboard.js";
import { DevicesPanel } from "#js/panels/devices.js";
import { DifferencesPanel } from "#js/panels/differences.js";
import { FieldPanel } from "#js/panels/field.js";
import { JoysticksPanel } from "#js/panels/joysticks.js";
import { KeysPanel } from "#js/panels/keys.js";
import { MatchPanel } from "#js/panels/match.js";
import { MechanismPanel } from "#js/panels/mechanism.js";
import { NetworkTablesPanel } from "#js/panels/networktables.js";
import { PlotPanel } from "#js/panels/plot.js";
import { SwervePanel } from "#js/panels/swerve.js";
import { TouchPanel } from "#js/panels/touch.js";
import { WidgetsPanel } from "#js/panels/widgets.js";

export const PANELS = {
  field: { title: "Field", component: FieldPanel },
  devices: { title: "Devices", component: DevicesPanel, devices: true },
  plot: { title: "Plot", component: PlotPanel },
  networktables: { title: "NetworkTables", component: NetworkTablesPanel },
  widgets: { title: "Published", component: WidgetsPanel },
  dashboard: { title: "Dashboard", component: DashboardPanel },
  mechanism: { title: "Mechanism", component: MechanismPanel },
  swerve: { title: "Swerve", component: SwervePanel },
  cameras: { title: "Cameras", component: CamerasPanel, served: true },
  changes: { title: "Changes", component: ChangesPanel },
  differences: { title: "Differences", component: DifferencesPanel },
  console: { title: "Console", component: ConsolePanel },
  match: { title: "Match", component: MatchPanel },
  joysticks: { title: "Joysticks", component: JoysticksPanel, devices: true },
  keys: { title: "Keys", component: KeysPanel, drives: true },
  touch: { title: "Touch sticks", component: TouchPanel, drives: true },
};

export function panelTitle(panel) {
  const [kind, number] = (panel ?? "").split(":");
  const title = PANELS[kind]?.title ?? kind;
  return number ? `${title} ${number}` : title;
}
