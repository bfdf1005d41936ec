// What vehicles and signals were asked, by which part of the policy, for whom and why.

import { actions, element } from "./controls";
import type { Drawing } from "./drawing";
import type { Lease } from "./stream";
import type { Moment, Track } from "./track";
import { changeText, consideredText, consideredWay } from "./ways";

/** A vehicle by its slot, or a signal by its number, of one run. */
export interface Thing {
  pane: number;
  onSignal: boolean;
  number: number;
}

/** A lease and how long it was in force, with the amount that it had last. */
export interface Asked {
  lease: Lease;
  from_s: number;
  to_s: number;
}

/** The leases of a run over time. A policy that repeats a lease, or changes its amount, asks once; each way considered counts. */
export class AskedLog {
  readonly all: Asked[] = [];
  private open = new Map<string, Asked>();
  private last: Lease[] | undefined;

  /** Takes the leases in force at a moment; moments ascend. */
  take(time_s: number, leases: Lease[]): void {
    if (leases !== this.last) this.change(time_s, leases);
    for (const asked of this.open.values()) asked.to_s = time_s;
  }

  /** What was asked of a thing until a moment, the newest first. */
  of(thing: Thing, time_s: number): Asked[] {
    const here = ({ lease, from_s }: Asked) =>
      lease.onSignal === thing.onSignal && lease.target === thing.number && from_s <= time_s + 1e-6;
    return this.all.filter(here).reverse();
  }

  private change(time_s: number, leases: Lease[]): void {
    this.last = leases;
    const open = new Map<string, Asked>();
    for (const lease of leases) {
      const { onSignal, target, action, policy, reason, beneficiary } = lease;
      const key = [onSignal, target, action, policy, reason, beneficiary, consideredWay(lease)].join();
      const asked = this.open.get(key) ?? { lease, from_s: time_s, to_s: time_s };
      if (!this.open.has(key)) this.all.push(asked);
      asked.lease = lease;
      open.set(key, asked);
    }
    this.open = open;
  }
}

function same(one: Thing, other: Thing): boolean {
  return one.pane === other.pane && one.onSignal === other.onSignal && one.number === other.number;
}

/** The next of those that something is asked of now, over all runs. */
export function nextAsked(tracks: Track[], time_s: number, chosen: Thing | undefined): Thing | undefined {
  const things = tracks.flatMap((track, pane) => {
    const targets = track.at(time_s).now.leases.map(({ onSignal, target }) => ({ pane, onSignal, number: target }));
    return targets.filter((one, i) => targets.findIndex((other) => same(one, other)) === i);
  });
  const last = chosen === undefined ? -1 : things.findIndex((thing) => same(thing, chosen));
  return things[(last + 1) % things.length];
}

export function nameOf(thing: Thing, track: Track, drawing: Drawing): string {
  return thing.onSignal
    ? `signal ${drawing.signals[thing.number]?.id ?? "?"}`
    : `vehicle ${track.names.vehicles[thing.number]?.id ?? "?"}`;
}

/** What a lease asks, without of whom. */
export function actionText(lease: Lease): string {
  const amounts: Record<number, string> = {
    0: ` ${((lease.amount / 10) * 3.6).toFixed(0)} km/h`,
    1: ` ${lease.amount}`,
    3: lease.amount === 0 ? " to the right" : " to the left",
    5: ` on ${lease.amount} links`,
  };
  if (consideredWay(lease) !== undefined) return "considered another way";
  return `${actions[lease.action] ?? "?"}${amounts[lease.action] ?? ""}`;
}

/** Which part of the policy asked for it, for whom and why. */
export function reasonText(lease: Lease, track: Track): string {
  const text = (number: number) => track.names.texts[number] ?? "?";
  const served = lease.beneficiary < 0 ? "" : ` for ${track.names.vehicles[lease.beneficiary]?.id ?? "?"}`;
  return `${served}: ${text(lease.reason)} (${text(lease.policy)})`;
}

const mostListed = 8;

/** The panel of the vehicle or signal that was chosen on the map. */
export class AskedPanel {
  readonly element = element("div", "asked");
  private readonly title = element("h4");
  private readonly list = element("ul");
  private written = "";

  constructor(
    private readonly tracks: Track[],
    private readonly drawing: Drawing,
  ) {
    this.element.setAttribute("role", "region");
    this.element.setAttribute("aria-label", "What was asked");
    this.element.append(this.title, this.list);
    this.show(undefined, []);
  }

  show(thing: Thing | undefined, moments: Moment[]): void {
    const [title, lines] = thing === undefined ? [hint, []] : this.words(thing, moments[thing.pane] as Moment);
    const written = [title, ...lines].join("\n");
    if (written === this.written) return;
    this.written = written;
    this.title.textContent = title;
    this.list.replaceChildren(...lines.map((line) => element("li", "", line)));
  }

  private words(thing: Thing, { now }: Moment): [string, string[]] {
    const track = this.tracks[thing.pane] as Track;
    const title = `${track.title}, ${nameOf(thing, track, this.drawing)}${this.state(thing, now)}`;
    const asked = track.asked.of(thing, now.time_s).map(({ lease, from_s, to_s }) => {
      const until = to_s >= now.time_s - 1e-6 ? "now" : `${to_s.toFixed(2)} s`;
      const what = consideredText(lease, from_s, track, this.drawing) ?? `${actionText(lease)}${reasonText(lease, track)}`;
      return { time_s: from_s, line: `${from_s.toFixed(2)} s to ${until}: ${what}` };
    });
    const changes = thing.onSignal ? [] : track.ways.of(thing.number, now.time_s).map((change) => (
      { time_s: change.time_s, line: changeText(change, track, this.drawing) }
    ));
    const all = [...changes, ...asked].sort((one, other) => other.time_s - one.time_s);
    const lines = all.slice(0, mostListed).map(({ line }) => line);
    if (all.length > mostListed) lines.push(`and ${all.length - mostListed} earlier`);
    if (lines.length === 0) lines.push("nothing was asked of it so far");
    return [title, [...lines, ...this.requests(thing, track, now.time_s)]];
  }

  private state(thing: Thing, now: Moment["now"]): string {
    if (thing.onSignal) return `: shows ${now.signals[thing.number] ?? "?"}`;
    const row = now.rowOf(thing.number);
    return row < 0 ? ": not on the road" : `: ${(((now.speed[row] as number) / 10) * 3.6).toFixed(0)} km/h`;
  }

  /** Requests for green that a signal got or that were made for a vehicle. */
  private requests(thing: Thing, track: Track, time_s: number): string[] {
    return track.marks
      .filter((mark) => (mark.kind === "request" || mark.kind === "grant") && mark.time_s <= time_s + 1e-6)
      .filter((mark) => (thing.onSignal ? mark.other : mark.vehicle) === thing.number)
      .slice(-mostListed)
      .reverse()
      .map((mark) => {
        const what = mark.kind === "request" ? "green requested" : "green granted";
        const vehicle = track.names.vehicles[mark.vehicle]?.id;
        const served = vehicle === undefined ? "" : ` for ${vehicle}`;
        return `${mark.time_s.toFixed(2)} s: ${what}${served} at signal ${this.drawing.signals[mark.other]?.id ?? "?"}`;
      });
  }
}

const hint = "Click a vehicle or a signal (or press c) to see what it was asked, by which part of the policy, and why.";
