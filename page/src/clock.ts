// Which moment is shown, and how it goes on: by itself, by hand, or as the server of a live run has it.

import { button, choice } from "./controls";
import type { Track } from "./track";

const speeds = [0.25, 0.5, 1, 2, 5, 10, 30];
/** Two live runs that are further apart are not in step any more: one of them is over, s. */
const inStep_s = 1.5;

/** What a server allows, where the run happens now. */
export interface LiveControl {
  allowed: boolean;
  pause(): void;
  go(): void;
  step(): void;
  speed(times: number): void;
}

/** What others do then. */
export interface ClockEvents {
  /** Another moment is to be shown. */
  moved(): void;
  /** A live run has grown, or is over. */
  grown(over: boolean): void;
}

function speedText(times: number): string {
  return times === 0 ? "as fast as possible" : `${times}×`;
}

function speedTexts(): { text: string; value: string }[] {
  return speeds.map((times) => ({ text: speedText(times), value: String(times) }));
}

export class Clock {
  readonly playButton: HTMLButtonElement;
  readonly speedLabel: HTMLElement;
  /** With reduced motion the picture changes once a simulated second and nothing glides. */
  readonly calm = matchMedia("(prefers-reduced-motion: reduce)");
  time_s: number;
  private readonly speedChoice: HTMLSelectElement;
  private speed = 5;
  private playing = false;
  /** Whether the newest frame of a live run is shown, whatever comes. */
  private newest = true;
  private last_ms = 0;
  private pending = 0;

  /** `live`: where the run happens now; no more once it is over. */
  constructor(
    private readonly tracks: Track[],
    private live: LiveControl | undefined,
    private readonly events: ClockEvents,
  ) {
    this.time_s = live === undefined ? this.firstTime() : this.newest_s;
    this.playButton = button("▶", "Play or pause (space)", () => this.togglePlay());
    this.speedLabel = choice("Speed", speedTexts(), String(this.speed), (value) => this.setSpeed(Number(value)));
    this.speedChoice = this.speedLabel.querySelector("select") as HTMLSelectElement;
  }

  get begin_s(): number {
    return Math.min(...this.tracks.map((track) => track.begin_s));
  }
  get end_s(): number {
    return Math.max(...this.tracks.map((track) => track.end_s));
  }
  get isLive(): boolean {
    return this.live !== undefined;
  }

  /** Whether a run is over. Of a live run the newest frame is not the end, unless the others went on. */
  isOver(track: Track, time_s: number): boolean {
    return this.live === undefined ? time_s >= track.end_s - 1e-6 : track.end_s < this.end_s - inStep_s;
  }

  start(): void {
    if (this.live !== undefined) this.play(true);
  }

  end(): void {
    cancelAnimationFrame(this.pending);
  }

  /** Shows a moment, and nothing else moves. */
  show(time_s: number): void {
    this.play(false);
    this.time_s = this.clamped(time_s);
    this.newest = this.time_s >= this.newest_s - 1e-6;
    this.events.moved();
  }

  step(direction: -1 | 1): void {
    if (this.live?.allowed === true) {
      if (direction > 0 && this.newest) {
        this.live.step();
        return this.play(false);
      }
      if (this.playing) this.live.pause();
    }
    const times = this.tracks.map((track) => track.beside(this.time_s, direction));
    this.show(direction < 0 ? Math.max(...times.filter((time) => time < this.time_s), this.begin_s) : this.nextOf(times));
  }

  togglePlay(): void {
    const { live } = this;
    if (live?.allowed === true) this.playing ? live.pause() : live.go();
    if (live !== undefined) this.newest = live.allowed || !this.playing;
    else if (!this.playing && this.time_s >= this.end_s - 1e-6) this.time_s = this.begin_s;
    this.play(!this.playing);
    if (live?.allowed === true) this.arrived();
  }

  /** What the server of a live run says: whether the runs wait, and their pace. */
  follow(paused: boolean, speed: number): void {
    if (this.live === undefined) return;
    this.chooseSpeed(speed);
    if (!this.live.allowed || paused !== this.playing || !this.newest) return;
    this.play(!paused);
    this.arrived();
  }

  /** A live run has gone on, or waits and its last frame was not shown yet. */
  arrived(): void {
    if (this.live === undefined || !this.newest || this.playing) return;
    this.time_s = this.newest_s;
    this.events.moved();
  }

  /** From now on this is the replay of what was seen. */
  over(): void {
    if (this.live === undefined) return;
    this.live = undefined;
    this.play(false);
    if (this.speed === 0) this.chooseSpeed(5);
    this.events.grown(true);
    this.events.moved();
  }

  /** The last moment that all live runs have reached; those that are over do not count. */
  private get newest_s(): number {
    const { end_s } = this;
    return Math.min(...this.tracks.map((track) => track.end_s).filter((time_s) => time_s >= end_s - inStep_s));
  }

  private firstTime(): number {
    const departures = this.tracks.flatMap((track) =>
      track.marks.filter((mark) => mark.kind === "departure").map((mark) => mark.time_s),
    );
    return departures.length === 0 ? this.begin_s : Math.max(this.begin_s, Math.min(...departures));
  }

  private clamped(time_s: number): number {
    return Math.min(Math.max(time_s, this.begin_s), this.end_s);
  }

  private nextOf(times: number[]): number {
    const later = times.filter((time) => time > this.time_s + 1e-6);
    return later.length === 0 ? this.end_s : Math.min(...later);
  }

  private setSpeed(times: number): void {
    this.speed = times;
    this.live?.speed(times);
  }

  /** Shows a speed, of which the server of a live run may have one of its own. */
  private chooseSpeed(times: number): void {
    this.speed = times;
    const value = String(times);
    if (![...this.speedChoice.options].some((option) => option.value === value))
      this.speedChoice.add(new Option(speedText(times), value));
    this.speedChoice.value = value;
  }

  private play(on: boolean): void {
    this.playing = on;
    this.playButton.textContent = on ? "❚❚" : "▶";
    this.last_ms = performance.now();
    cancelAnimationFrame(this.pending);
    if (on) this.pending = requestAnimationFrame(() => this.tick());
  }

  private tick(): void {
    const now_ms = performance.now();
    const passed_s = ((now_ms - this.last_ms) / 1000) * this.speed;
    if (this.live !== undefined) {
      this.time_s = this.newest_s;
      this.events.grown(false);
      this.last_ms = now_ms;
      this.events.moved();
    } else if (!this.calm.matches || passed_s >= 1) {
      this.time_s = this.clamped(this.time_s + (this.calm.matches ? Math.floor(passed_s) : passed_s));
      this.last_ms = now_ms;
      this.events.moved();
    }
    if (this.live === undefined && this.time_s >= this.end_s) return this.play(false);
    this.pending = requestAnimationFrame(() => this.tick());
  }
}
