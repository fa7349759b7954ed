// Playing a recorded run: the moment that is shown goes on by itself.
import { model } from "#js/model.js";
import { length, live, look } from "#js/past.js";
import { positionOf, speedAt } from "#js/speeds.js";

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

  // Of the speed slider.
  get position() {
    return positionOf(this.speed);
  }

  set position(position) {
    this.speed = speedAt(position);
    model.announce("playback");
  }

  #next = (now) => {
    if (!this.playing) return;
    if (model.past && Math.abs(model.past.t - this.#t) > 0.5) this.#t = model.past.t; // another moment was chosen
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
