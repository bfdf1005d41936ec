// Speed and way of the followed vehicle over time, one line for each run.

import uPlot from "uplot";
import type { Journey, Track } from "./track";

/** As in the report: the baseline is grey. Of two runs without one, or of two of it, the first is. */
const grey = "#8a8f98";
const green = "#0a7d4f";
function isBelow(tracks: Track[], i: number): boolean {
  const isUsual = tracks.map((track) => track.about.condition.startsWith("baseline"));
  return i === (isUsual.filter((usual) => usual).length === 1 ? isUsual.indexOf(true) : 0);
}

/** From 0, and wide enough for a line at the top to be seen. */
export function rangeOf(highest: number | null): [number, number] {
  return [0, highest === null || highest <= 0 ? 1 : 1.05 * highest];
}

/** The grey line is drawn first and wide: it shows on both sides of one that runs on it. */
export function drawingOrder(tracks: Track[]): number[] {
  return tracks.map((_, i) => i).sort((a, b) => Number(isBelow(tracks, b)) - Number(isBelow(tracks, a)));
}

interface Curve {
  title: string;
  unit: string;
  of(journey: Journey): number[];
}
const curves: Curve[] = [
  { title: "Speed", unit: "km/h", of: (journey) => journey.speed_mps.map((speed) => speed * 3.6) },
  { title: "Distance travelled", unit: "m", of: (journey) => journey.distance_m },
];

export class Curves {
  readonly element = document.createElement("div");
  private plots: uPlot[] = [];
  private time_s = 0;

  constructor(private readonly chosen: (time_s: number) => void) {
    this.element.className = "curves";
  }

  show(tracks: Track[], slots: (number | undefined)[]): void {
    this.end();
    this.element.replaceChildren();
    const journeys = tracks.map((track, i) => {
      const slot = slots[i];
      return slot === undefined ? { time_s: [], speed_mps: [], distance_m: [] } : track.journey(slot);
    });
    if (journeys.every((journey) => journey.time_s.length === 0)) return;
    for (const curve of curves) this.plots.push(this.plot(curve, tracks, journeys));
  }

  /** Marks the present moment. */
  at(time_s: number): void {
    if (Math.abs(time_s - this.time_s) < 0.2) return;
    this.time_s = time_s;
    for (const plot of this.plots) plot.redraw(false);
  }

  resize(): void {
    for (const plot of this.plots) plot.setSize({ width: this.width(), height: 150 });
  }

  end(): void {
    for (const plot of this.plots) plot.destroy();
    this.plots = [];
  }

  private width(): number {
    const full = this.element.clientWidth || 320;
    return full < 640 ? full : Math.floor((full - 16) / 2);
  }

  private plot(curve: Curve, tracks: Track[], journeys: Journey[]): uPlot {
    const order = drawingOrder(tracks);
    const tables = order.map((i) => {
      const journey = journeys[i] as Journey;
      return [journey.time_s, curve.of(journey)] as [number[], number[]];
    });
    const figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    caption.textContent = `${curve.title} of the emergency vehicle, ${curve.unit}`;
    for (const [i, track] of tracks.entries()) {
      const name = document.createElement("span");
      name.textContent = ` — ${track.title}`;
      name.style.color = isBelow(tracks, i) ? grey : green;
      caption.append(name);
    }
    figure.append(caption);
    this.element.append(figure);
    const ink = getComputedStyle(this.element).color;
    const axis = { stroke: ink, grid: { stroke: "rgba(128,128,128,0.25)" }, ticks: { stroke: "rgba(128,128,128,0.4)" } };
    const plot = new uPlot(
      {
        width: this.width(),
        height: 150,
        scales: { x: { time: false }, y: { range: (_, __, highest) => rangeOf(highest) } },
        cursor: { drag: { x: false, y: false }, points: { show: false } },
        legend: { show: false },
        axes: [{ ...axis, values: (_, values) => values.map((value) => `${value} s`) }, { ...axis, size: 58, space: 24 }],
        series: [
          {},
          ...order.map((i) => ({
            label: (tracks[i] as Track).title,
            stroke: isBelow(tracks, i) ? grey : green,
            width: isBelow(tracks, i) ? 6 : 2,
            spanGaps: true,
          })),
        ],
        hooks: { draw: [(drawn) => this.drawNow(drawn, ink)] },
      },
      uPlot.join(tables),
      figure,
    );
    plot.over.addEventListener("click", () => {
      const { left } = plot.cursor;
      if (left !== undefined && left !== null && left >= 0) this.chosen(plot.posToVal(left, "x"));
    });
    return plot;
  }

  private drawNow(plot: uPlot, ink: string): void {
    const x = plot.valToPos(this.time_s, "x", true);
    if (x < plot.bbox.left || x > plot.bbox.left + plot.bbox.width) return;
    plot.ctx.save();
    plot.ctx.strokeStyle = ink;
    plot.ctx.beginPath();
    plot.ctx.moveTo(x, plot.bbox.top);
    plot.ctx.lineTo(x, plot.bbox.top + plot.bbox.height);
    plot.ctx.stroke();
    plot.ctx.restore();
  }
}
