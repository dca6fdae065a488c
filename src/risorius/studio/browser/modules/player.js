// The clock of a take: at the display's pace. What it shows comes from targets and weights that
// the page holds; until they are there, from frames of the studio.
const LATE = 500; // milliseconds after which a frame of the studio is asked for again
const LONGEST = 0.25; // seconds that one picture may take; a hidden page pauses

export class Player {
  constructor(viewport) {
    this.viewport = viewport;
    this.facts = null;
    this.take = null;
    this.time = 0;
    this.speed = 1;
    this.loop = true;
    this.playing = false;
    this.shown = null;
    this.last = 0;
    this.follow = () => {};
    this.waiting = { since: 0, serial: -1 };
  }

  // A take of the studio: its number, duration and rate. One of the same number goes on.
  load(facts) {
    if (this.facts?.number !== facts.number) {
      this.time = 0;
      this.playing = false;
    }
    this.facts = facts;
    this.seek(Math.min(this.time, facts.duration));
  }

  bring(head, data, offset) {
    const count = head.frames * head.columns.length;
    const weights = new Float32Array(data.slice(offset, offset + 4 * count));
    offset += 4 * count;
    const turns = head.turns ? new Float32Array(data.slice(offset, offset + 16 * head.frames)) : null;
    this.take = { ...head, weights, turns };
    this.again();
  }

  again() {
    this.shown = null;
    this.viewport.touch();
  }

  rest() {
    this.facts = null;
    this.playing = false;
    this.viewport.meshes.morph.rest();
    this.viewport.meshes.turn(null);
    this.viewport.touch();
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.facts?.duration ?? 0);
    this.viewport.touch();
    this.follow();
  }

  toggle() {
    if (!this.facts) return;
    this.playing = !this.playing;
    if (this.playing && !this.loop && this.time >= this.facts.duration) this.time = 0;
    this.follow();
  }

  // Whether the page can show the take alone. Colours by numbers are made by the studio.
  alone() {
    const { morph } = this.viewport.meshes;
    return this.take && this.facts && !this.viewport.settings.painted
      && this.take.number === this.facts.number && this.take.targets === morph.number;
  }

  tick(now) {
    const passed = Math.min((now - this.last) / 1000, LONGEST);
    this.last = now;
    if (!this.facts) return;
    if (this.playing) this.advance(passed * this.speed);
    const way = this.alone() ? "alone" : "asked";
    if (this.shown?.time === this.time && this.shown.way === way) return;
    if (way === "alone") this.draw();
    else if (!this.ask(now)) return;
    this.shown = { time: this.time, way };
  }

  advance(step) {
    const { duration } = this.facts;
    this.time += step;
    if (this.time >= duration) {
      if (this.loop && duration > 0) this.time %= duration;
      else {
        this.time = duration;
        this.playing = false;
      }
    }
    this.follow();
  }

  draw() {
    const { take } = this, { meshes, views } = this.viewport;
    const at = Math.min(this.time * take.rate, take.frames - 1);
    const first = Math.min(Math.floor(at), Math.max(take.frames - 2, 0));
    const second = Math.min(first + 1, take.frames - 1), share = at - first;
    const weights = new Float32Array(meshes.morph.weights.length), wide = take.columns.length;
    take.columns.forEach((column, k) => {
      weights[column] = (1 - share) * take.weights[first * wide + k]
        + share * take.weights[second * wide + k];
    });
    meshes.morph.apply(weights, views.renderer);
    meshes.turn(take.turns && [...take.pivot, ...mixed(take.turns, first, second, share)]);
    this.viewport.stats.alone += 1;
    this.viewport.touch();
  }

  // Ask the studio for a frame, one at a time.
  ask(now) {
    const { stats, meshes } = this.viewport;
    if (meshes.morph.active) meshes.morph.rest();
    if (stats.serial === this.waiting.serial && now - this.waiting.since < LATE) return false;
    this.waiting = { since: now, serial: stats.serial };
    this.viewport.emit("seek", { time: this.time });
    return true;
  }
}

function mixed(turns, first, second, share) {
  const q = [0, 1, 2, 3].map((k) =>
    (1 - share) * turns[4 * first + k] + share * turns[4 * second + k]);
  const length = Math.hypot(...q);
  return q.map((value) => value / length);
}
