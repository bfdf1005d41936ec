// Which emergency vehicle of each run is followed, and what is said of it.

import { choice, element, LeaseList } from "./controls";
import type { Drawing } from "./drawing";
import type { FrameState } from "./stream";
import { describe } from "./timeline";
import type { Track } from "./track";
import { middleOf, reasonOf } from "./ways";

export class Followed {
  readonly element: HTMLElement;
  /** By run. */
  slots: (number | undefined)[] = [];
  private readonly choice: HTMLSelectElement;

  /** `wanted`: id of the emergency vehicle to follow; empty for one that is on the road, whichever it is. */
  constructor(
    private readonly tracks: Track[],
    private wanted: string,
    chosen: (id: string) => void,
  ) {
    this.element = choice("Emergency vehicle", [{ text: "any on the road", value: "" }], "", chosen);
    this.choice = this.element.querySelector("select") as HTMLSelectElement;
    this.choice.setAttribute("aria-label", "Emergency vehicle to follow");
    this.list();
  }

  get isAny(): boolean {
    return this.slots.some((slot) => slot !== undefined);
  }

  /** The moment to go to if the vehicle is not on the road now: its departure. */
  want(id: string, time_s: number): number | undefined {
    this.wanted = id;
    this.choice.value = id;
    const isHere = (track: Track) => track.emergency.some(
      (slot) => track.names.vehicles[slot]?.id === id && track.at(time_s).now.rowOf(slot) >= 0,
    );
    return this.tracks.some(isHere) ? undefined : this.entries().get(id);
  }

  /** The id of the next or last one in the order in which they enter. */
  beside(by: 1 | -1): string | undefined {
    const ids = [...this.entries()].sort((one, other) => one[1] - other[1]).map(([id]) => id);
    if (ids.length === 0) return undefined;
    const slot = this.slots[0];
    const now = this.wanted !== "" ? this.wanted : slot === undefined ? "" : (this.tracks[0]?.names.vehicles[slot]?.id ?? "");
    return ids[(ids.indexOf(now) + by + ids.length) % ids.length] as string;
  }

  /** The wanted vehicle; without one that which is followed already, or another that is on the road. Whether this changed any. */
  choose(time_s: number): boolean {
    const before = this.slots;
    this.slots = this.tracks.map((track, i) => {
      const named = track.emergency.find((slot) => track.names.vehicles[slot]?.id === this.wanted);
      if (named !== undefined) return named;
      const { now } = track.at(time_s);
      const isHere = (slot: number | undefined) => slot !== undefined && now.rowOf(slot) >= 0;
      return isHere(before[i]) ? before[i] : (track.emergency.find(isHere) ?? before[i] ?? track.emergency[0]);
    });
    this.list();
    return this.slots.some((slot, i) => slot !== before[i]);
  }

  /** What lies ahead of the followed vehicles, and the ways that they left a moment ago. */
  placesAhead(time_s: number, drawing: Drawing): [number, number][] {
    return this.tracks.flatMap((track, i) => {
      const { now } = track.at(time_s);
      const seen = now.ways.find(({ slot }) => slot === this.slots[i]);
      if (seen === undefined) return [];
      const change = track.ways.shown(seen.slot, now.time_s);
      const ahead = (way: number, at: number) => (track.names.ways[way] ?? []).slice(at);
      const former = change === undefined ? [] : ahead(change.before, change.at);
      return [...ahead(seen.way, seen.at), ...former].flatMap((edge) => middleOf(drawing, edge));
    });
  }

  /** The emergency vehicles of all runs by id, with the time at which each first enters. */
  private entries(): Map<string, number> {
    const entries = new Map<string, number>();
    for (const track of this.tracks) {
      for (const slot of track.emergency) {
        const id = track.names.vehicles[slot]?.id ?? "?";
        const from_s = track.journey(slot).time_s[0] ?? track.begin_s;
        entries.set(id, Math.min(entries.get(id) ?? from_s, from_s));
      }
    }
    return entries;
  }

  /** In a live run vehicles come. */
  private list(): void {
    const entries = this.entries();
    if (this.choice.length === entries.size + 1) return;
    for (const [id, from_s] of [...entries].slice(this.choice.length - 1))
      this.choice.add(new Option(`${id}, from ${from_s.toFixed(0)} s`, id));
    this.choice.value = this.wanted;
  }
}

/** What is said below the map of a run. */
export class Caption {
  readonly element = element("div", "caption");
  readonly leases: LeaseList;

  constructor(
    private readonly track: Track,
    drawing: Drawing,
  ) {
    this.leases = new LeaseList(track, (signal) => drawing.signals[signal]?.id ?? "?");
  }

  show(slot: number | undefined, now: FrameState, isOver: boolean): void {
    const { track } = this;
    const row = slot === undefined ? -1 : now.rowOf(slot);
    const speed = row < 0 ? "" : `, ${(((now.speed[row] as number) / 10) * 3.6).toFixed(0)} km/h`;
    const state = row >= 0 ? "" : `, ${isOver ? "run over" : this.absence(slot, now.time_s)}`;
    const id = slot === undefined ? "no emergency vehicle yet" : (track.names.vehicles[slot]?.id ?? "?");
    const change = row < 0 ? undefined : track.ways.shown(slot as number, now.time_s);
    const turned = change === undefined ? "" : `, another way since ${change.time_s.toFixed(0)} s: ${reasonOf(change, track)}`;
    const text = `${track.title}: ${id}${speed}${state}${turned}; ${now.count} vehicles`;
    if (this.element.textContent !== text) this.element.textContent = text;
    this.element.title = describe(track);
    this.leases.show(now);
  }

  /** Why a vehicle is not on the road while the run goes on. */
  private absence(slot: number | undefined, time_s: number): string {
    const from_s = slot === undefined ? undefined : this.track.journey(slot).time_s[0];
    if (from_s === undefined) return "the run goes on";
    return time_s < from_s ? `enters at ${from_s.toFixed(0)} s` : "not on the road any more";
  }
}
