// Curve, clock and buttons of a take. The viewport of the page keeps the time.
export default {
  template: `
    <div class="rv-time" v-show="facts">
      <svg ref="line" class="rv-line" viewBox="0 0 300 54" preserveAspectRatio="none" role="slider"
           tabindex="0" aria-label="timeline" data-mark="timeline" aria-valuemin="0"
           :aria-valuemax="facts ? facts.duration : 1" :aria-valuenow="time"
           @pointerdown="press" @pointermove="move" @pointerup="release" @keydown="key">
        <rect width="300" height="54" fill="#191c1f"/>
        <polyline :points="points" fill="none" stroke="#b9785a" stroke-width="1.4"
                  vector-effect="non-scaling-stroke"/>
        <line :x1="place" :x2="place" y1="0" y2="54" stroke="#ffd9c4" stroke-width="1.5"
              vector-effect="non-scaling-stroke"/>
      </svg>
      <div class="rv-deck">
        <q-btn flat round dense :icon="playing ? 'pause' : 'play_arrow'" data-mark="play"
               :aria-label="playing ? 'pause' : 'play'" @click="toggle"/>
        <span class="st-number" data-mark="clock">{{ time.toFixed(2) }} s</span>
        <q-btn-toggle v-model="speed" flat dense no-caps size="sm" :options="speeds"
                      data-mark="speed" @update:model-value="follow"/>
        <q-toggle v-model="loop" dense label="loop" data-mark="loop"
                  @update:model-value="follow"/>
      </div>
    </div>`,
  data() {
    return {
      facts: null, time: 0, playing: false, speed: 1, loop: true, held: false,
      speeds: [[0.25, "¼"], [0.5, "½"], [1, "1"], [2, "2"]].map(([value, label]) => ({ value, label })),
    };
  },
  computed: {
    place() { return (300 * this.time) / Math.max(this.facts?.duration ?? 1, 1e-3); },
    points() {
      const curve = this.facts?.curve ?? [], last = Math.max(curve.length - 1, 1);
      return curve.map((v, k) => `${((300 * k) / last).toFixed(1)},${(50 - 44 * v).toFixed(1)}`)
        .join(" ");
    },
  },
  methods: {
    player() { return window.risoriusViewport.player; },
    load(facts) {
      this.facts = facts;
      const player = this.player();
      player.follow = () => { this.time = player.time; this.playing = player.playing; };
      player.load(facts);
      this.follow();
    },
    follow() { Object.assign(this.player(), { speed: this.speed, loop: this.loop }); },
    toggle() { this.player().toggle(); },
    press(e) { this.held = true; this.$refs.line.setPointerCapture(e.pointerId); this.move(e); },
    move(e) {
      if (!this.held) return;
      const box = this.$refs.line.getBoundingClientRect();
      this.go((this.facts.duration * (e.clientX - box.left)) / box.width);
    },
    release() { this.held = false; },
    go(time) {
      const player = this.player();
      player.playing = false;
      player.seek(time);
    },
    key(e) {
      const step = { ArrowLeft: -1, ArrowRight: 1, Home: -1e9, End: 1e9 }[e.key];
      if (!step) return;
      e.preventDefault();
      this.go(this.time + step / this.facts.rate);
    },
  },
};
