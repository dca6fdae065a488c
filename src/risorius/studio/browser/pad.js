// A field with a knob: x to the right, y upwards; a double click rests.
export default {
  template: `
    <div class="rv-pad" ref="pad" tabindex="0" role="slider"
         @pointerdown="press" @pointermove="move" @pointerup="release" @dblclick="rest">
      <div class="rv-cross-x" :style="{left: zero[0] + '%'}"></div>
      <div class="rv-cross-y" :style="{bottom: zero[1] + '%'}"></div>
      <div class="rv-knob" :style="{left: place[0] + '%', bottom: place[1] + '%'}"></div>
    </div>`,
  props: { low: Array, high: Array, value: Array },
  data() { return { now: [...this.value], held: false, sent: 0 }; },
  watch: { value(next) { if (!this.held) this.now = [...next]; } },
  computed: {
    place() { return this.share(this.now); },
    zero() { return this.share([0, 0]); },
  },
  methods: {
    share(v) {
      return [0, 1].map((k) => (100 * (v[k] - this.low[k])) / (this.high[k] - this.low[k]));
    },
    read(e) {
      const box = this.$refs.pad.getBoundingClientRect();
      const part = [(e.clientX - box.left) / box.width, 1 - (e.clientY - box.top) / box.height];
      this.now = part.map((p, k) => {
        const value = this.low[k] + Math.min(Math.max(p, 0), 1) * (this.high[k] - this.low[k]);
        return Math.abs(value) < 0.03 * (this.high[k] - this.low[k]) ? 0 : value;
      });
    },
    press(e) { this.held = true; this.$refs.pad.setPointerCapture(e.pointerId); this.move(e); },
    move(e) {
      if (!this.held) return;
      this.read(e);
      if (e.timeStamp - this.sent > 40) {
        this.sent = e.timeStamp;
        this.$emit("moved", { x: this.now[0], y: this.now[1] });
      }
    },
    release() {
      if (!this.held) return;
      this.held = false;
      this.$emit("kept", { x: this.now[0], y: this.now[1] });
    },
    rest() { this.now = [0, 0]; this.$emit("kept", { x: 0, y: 0 }); },
  },
};
