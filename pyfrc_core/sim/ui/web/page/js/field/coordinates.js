// How places on the field are written. The page, like `hal_data` and physics, computes in feet with y downwards and
// clockwise radians; robot code has metres from a corner, with y upwards and counterclockwise angles.

import { wrapped } from "#js/format.js";
import { FOOT } from "#js/units.js";

const DEGREES = 180 / Math.PI;

// The values of `field.coordinates` in sim/config.json.
export const COORDINATES = {
  pyfrc: "Feet, y downwards, clockwise",
  blue: "Metres, blue corner",
  "blue-feet": "Feet, blue corner",
  alliance: "Metres, alliance's corner",
  "alliance-feet": "Feet, alliance's corner",
};

// Feet per unit, and the unit's name.
export function unitOf(name) {
  return name === "blue" || name === "alliance" ? { feet: 1 / FOOT, unit: "m" } : { feet: 1, unit: "ft" };
}

// Whether places count from the red wall: half a turn from the blue one.
export function isFromRed(name, alliance) {
  return name.startsWith("alliance") && alliance.startsWith("red");
}

// The corner from which places count, in feet as the page has them.
/** @returns {[number, number]} */
export function originOf(field, name, alliance) {
  if (name === "pyfrc") return [0, 0];
  return isFromRed(name, alliance) ? [field.width, 0] : [0, field.height];
}

// A pose as it is written: { x, y, degrees, unit }, with degrees above -180 and up to 180.
export function written([x, y, radians], field, name, alliance) {
  const { feet, unit } = unitOf(name);
  if (name === "pyfrc") return { x, y, degrees: wrapped(radians * DEGREES), unit };
  const fromRed = isFromRed(name, alliance);
  return {
    x: (fromRed ? field.width - x : x) / feet,
    y: (fromRed ? y : field.height - y) / feet,
    degrees: wrapped(-radians * DEGREES + (fromRed ? 180 : 0)),
    unit,
  };
}
