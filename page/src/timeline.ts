// The time line: where we are, and what happened when, one row of ticks for each run.

import { type Mark, markNames } from "./stream";
import type { Track } from "./track";

const drawn: readonly string[] = ["request", "grant", "braking", "collision", "departure", "arrival", "teleport", "way"];
const svgSpace = "http://www.w3.org/2000/svg";

export class TimeLine {
  readonly element = document.createElement("div");
  readonly slider = document.createElement("input");
  private readonly marks = document.createElementNS(svgSpace, "svg");
  private counted = -1;

  constructor(private readonly moved: (time_s: number) => void) {
    this.element.className = "time-line";
    this.slider.type = "range";
    this.slider.setAttribute("aria-label", "Time, seconds of the simulation");
    this.slider.addEventListener("input", () => this.moved(Number(this.slider.value)));
    this.marks.setAttribute("class", "marks");
    this.marks.setAttribute("preserveAspectRatio", "none");
    this.marks.setAttribute("role", "img");
    this.element.append(this.slider, this.marks);
  }

  show(time_s: number, begin_s: number, end_s: number, tracks: Track[]): void {
    this.slider.min = String(begin_s);
    this.slider.max = String(end_s);
    this.slider.step = "0.05";
    this.slider.value = String(time_s);
    this.slider.setAttribute("aria-valuetext", `${time_s.toFixed(1)} s`);
    const count = tracks.reduce((sum, track) => sum + track.marks.length, 0) + end_s / 1e6;
    if (count !== this.counted) this.drawMarks(begin_s, end_s, tracks);
    this.counted = count;
  }

  private drawMarks(begin_s: number, end_s: number, tracks: Track[]): void {
    const span_s = Math.max(end_s - begin_s, 1e-3);
    this.marks.setAttribute("viewBox", `0 0 1000 ${10 * tracks.length}`);
    this.marks.setAttribute("aria-label", tracks.map((track) => describe(track)).join("; "));
    this.marks.replaceChildren();
    tracks.forEach((track, row) => {
      for (const mark of track.marks) {
        if (!drawn.includes(mark.kind)) continue;
        const x = (1000 * (mark.time_s - begin_s)) / span_s;
        const tick = document.createElementNS(svgSpace, "rect");
        tick.setAttribute("class", mark.kind);
        tick.setAttribute("x", String(x - 1.2));
        tick.setAttribute("y", String(10 * row + 1));
        tick.setAttribute("width", "2.4");
        tick.setAttribute("height", "8");
        this.marks.append(tick);
      }
    });
  }
}

/** `corridor: 3 requests, 2 grants, no collision`. */
export function describe(track: Track): string {
  const count = (kind: string) => track.marks.filter((mark: Mark) => mark.kind === kind).length;
  const words = markNames
    .filter((kind) => kind !== "departure" && kind !== "arrival")
    .map((kind) => `${count(kind)} ${kind}${count(kind) === 1 ? "" : "s"}`);
  const changed = track.ways.all.length;
  if (changed > 0) words.push(`another way taken ${changed === 1 ? "once" : `${changed} times`}`);
  return `${track.title}: ${words.join(", ")}`;
}
