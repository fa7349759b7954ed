// The slider of speeds, from 0 to 1: each doubling takes the same distance. `whole` is the share of the slider that has speeds.
import { model } from "#js/model.js";

export function positionOf(speed, whole = 1) {
  const { slowest, fastest } = model.hello.options.speeds;
  const limited = Math.min(Math.max(speed, slowest), fastest);
  return (whole * Math.log(limited / slowest)) / Math.log(fastest / slowest);
}

export function speedAt(position, whole = 1) {
  const { slowest, fastest } = model.hello.options.speeds;
  const exact = slowest * (fastest / slowest) ** (Math.min(position, whole) / whole);
  if (exact > 0.93 && exact < 1.07) return 1;
  return Number(exact.toFixed(exact < 1 ? 2 : 1));
}
