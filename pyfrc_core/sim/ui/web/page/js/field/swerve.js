// What robot code publishes of a swerve drive: structs of module states and chassis speeds, tables of the type "SwerveDrive".
import { MODULES, WANTED, swerveStates, swerveTables, topicsOf } from "#js/field/published.js";
import { plain } from "#js/format.js";

const SPEEDS = /^struct:Chassis(Speeds|Velocit(y|ies))$/;

// The beginnings of the paths of all values that the drawing may show.
export function swerveNeeds() {
  return [...topicsOf(MODULES), ...topicsOf(SPEEDS)].map((path) => `${path}/`).concat(swerveTables().map((path) => `${path}/`));
}

// The drive at the moment that is shown: { measured, wanted: [{ speed in m/s, angle in radians }], speeds: { vx, vy, omega },
// heading in radians, counterclockwise }; null for what is not published.
// topics: the paths to show; of what they do not name, the first one that suits
export function swerveDrive({ values, robot }, topics = []) {
  const chosen = (found) => found.find(({ path }) => topics.includes(path)) ?? found[0];
  const states = swerveStates(values);
  const named = states.filter(({ path }) => topics.includes(path));
  const measured = named.find(({ path }) => path === topics[0]) ?? chosen(states.filter(({ wanted }) => !wanted));
  const wanted = named.find((each) => each !== measured) ?? chosen(states.filter((each) => each.wanted && each !== measured));
  return { measured: measured?.states ?? null, wanted: wanted?.states ?? null, speeds: speedsOf(values, topics), heading: headingOf(values, robot, measured?.path) };
}

function speedsOf(values, topics) {
  const all = topicsOf(SPEEDS);
  const path = all.find((each) => topics.includes(each)) ?? all.find((each) => !WANTED.test(each)) ?? all[0];
  const [vx, vy, omega] = ["vx", "vy", "omega"].map((part) => plain(values.get(`${path}/${part}`)));
  return [vx, vy, omega].every((each) => typeof each === "number") ? { vx, vy, omega } : null;
}

function headingOf(values, robot, path) {
  const angle = plain(values.get(`${path}/Robot Angle`));
  if (typeof angle === "number") return angle;
  return robot ? -robot[2] : null; // the page's angles are clockwise
}
