// Playing a recorded run: the moment that is shown goes on by itself.
import { model } from "./model.js";
import { length, live, look } from "./past.js";

const SLOWEST = 0.1;
const FASTEST = 8;

class Playback {
  playing = false;
  speed = 1;
  #t = 0;
  #shown = 0;

  toggle() {
    if (this.playing) return this.pause();
    this.playing = true;
    this.#t = model.past?.t ?? 0; // from the end, it begins again
    this.#shown = performance.now();
    look(this.#t);
    requestAnimationFrame(this.#next);
    model.announce("playback");
  }

  pause() {
    this.playing = false;
    model.announce("playback");
  }

  // Each doubling takes the same distance on the slider, from 0 to 1.
  get position() {
    return Math.log(this.speed / SLOWEST) / Math.log(FASTEST / SLOWEST);
  }

  set position(share) {
    const exact = SLOWEST * (FASTEST / SLOWEST) ** share;
    this.speed = exact > 0.93 && exact < 1.07 ? 1 : Number(exact.toFixed(exact < 1 ? 2 : 1));
    model.announce("playback");
  }

  #next = (now) => {
    if (!this.playing) return;
    if (model.past && Math.abs(model.past.t - this.#t) > 0.5) this.#t = model.past.t; // somebody chose another moment
    this.#t += (Math.max(now - this.#shown, 0) / 1000) * this.speed;
    this.#shown = now;
    if (this.#t >= length()) {
      live();
      return this.pause();
    }
    look(this.#t);
    requestAnimationFrame(this.#next);
  };
}

export const playback = new Playback();
