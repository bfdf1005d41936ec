// The ways of emergency vehicles: what lies ahead, where two differ, when one was changed and why.

import type { Drawing } from "./drawing";
import type { Lease, SeenWay } from "./stream";
import type { Track } from "./track";

export type Point = [number, number];

/** A vehicle drives another way than at the frame before. */
export interface WayChange {
  slot: number;
  time_s: number;
  /** Numbers of ways. */
  before: number;
  after: number;
  /** Place of the last edge that was entered, in both ways. */
  at: number;
}

/** The former way is shown so long, s. */
export const formerShown_s = 30;
/** A change is seen at a frame, and a lease may have ended since the one before, s. */
const leaseOver_s = 2.5;
/** traffic::StandBack and traffic::TakeRoute. */
const [standBack, takeRoute] = [8, 9];

/** The changes of a run over time. */
export class WayLog {
  readonly all: WayChange[] = [];
  private readonly last = new Map<number, number>();

  /** Takes the ways of a frame, and returns what changed; frames ascend in time. */
  take(time_s: number, ways: SeenWay[]): WayChange[] {
    const changes: WayChange[] = [];
    for (const { slot, way, at } of ways) {
      const before = this.last.get(slot);
      this.last.set(slot, way);
      if (before !== undefined && before !== way) changes.push({ slot, time_s, before, after: way, at });
    }
    this.all.push(...changes);
    return changes;
  }

  /** Those of a vehicle until a moment, the newest first. */
  of(slot: number, time_s: number): WayChange[] {
    return this.all.filter((change) => change.slot === slot && change.time_s <= time_s + 1e-6).reverse();
  }

  /** The number of a vehicle's way at a moment. */
  at(slot: number, time_s: number): number | undefined {
    const next = this.all.find((change) => change.slot === slot && change.time_s > time_s + 1e-6);
    return next?.before ?? this.last.get(slot);
  }

  /** The one whose former way is still shown. */
  shown(slot: number, time_s: number): WayChange | undefined {
    const newest = this.of(slot, time_s)[0];
    return newest !== undefined && newest.time_s > time_s - formerShown_s ? newest : undefined;
  }
}

/** The middle of the lanes for cars of an edge, in driving order. */
export function middleOf(drawing: Drawing, edge: number): Point[] {
  const [first, count] = drawing.edges[edge] ?? [0, 0];
  const lanes = drawing.lanes.slice(first, first + count);
  const driven = lanes.filter(({ kind }) => kind !== "walk");
  const paths = (driven.length > 0 ? driven : lanes).map(({ path }) => path);
  const [right, left] = [paths[0], paths.at(-1)];
  if (right === undefined || left === undefined) return [];
  const other = left.length === right.length ? left : right;
  const points: Point[] = [];
  for (let i = 0; i + 1 < right.length; i += 2)
    points.push([((right[i] as number) + (other[i] as number)) / 2, ((right[i + 1] as number) + (other[i + 1] as number)) / 2]);
  return points;
}

/** Where a line comes nearest to a place, and the number of the piece that does. */
function nearest(line: Point[], [x, y]: Point): { at: Point; piece: number } {
  let best = { at: line[0] as Point, piece: 0 };
  let best_m = Infinity;
  for (let i = 0; i + 1 < line.length; ++i) {
    const [ax, ay] = line[i] as Point;
    const [bx, by] = line[i + 1] as Point;
    const square = (bx - ax) ** 2 + (by - ay) ** 2;
    const share = square === 0 ? 0 : Math.max(0, Math.min(1, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / square));
    const at: Point = [ax + share * (bx - ax), ay + share * (by - ay)];
    const away_m = Math.hypot(at[0] - x, at[1] - y);
    if (away_m < best_m) {
      best_m = away_m;
      best = { at, piece: i };
    }
  }
  return best;
}

/** The rest of a way from a place on its edge number `at` on. */
export function lineAhead(drawing: Drawing, way: number[], at: number, place: Point): Point[] {
  const here = middleOf(drawing, way[at] as number);
  if (here.length === 0) return [];
  const { piece } = nearest(here, place);
  return [place, ...here.slice(piece + 1), ...way.slice(at + 1).flatMap((edge) => middleOf(drawing, edge))];
}

/** The pieces of the former way behind `at` that the present one does not take, joined to it at both ends. */
export function formerLines(drawing: Drawing, former: number[], present: number[], at: number): Point[][] {
  const taken = new Set(present.slice(at));
  const lines: Point[][] = [];
  let open: Point[] | undefined;
  former.forEach((edge, i) => {
    if (i < at) return;
    const line = middleOf(drawing, edge);
    if (taken.has(edge)) {
      if (open !== undefined && line[0] !== undefined) open.push(line[0]);
      open = undefined;
      return;
    }
    if (open === undefined) {
      const fork = i > 0 ? middleOf(drawing, former[i - 1] as number).at(-1) : undefined;
      open = fork === undefined ? [] : [fork];
      lines.push(open);
    }
    open.push(...line);
  });
  return lines;
}

export function lengthOf(line: Point[]): number {
  return line.slice(1).reduce((sum, [x, y], i) => sum + Math.hypot(x - (line[i] as Point)[0], y - (line[i] as Point)[1]), 0);
}

/** The number of the way that a policy considered and did not ask for. */
export function consideredWay(lease: Lease): number | undefined {
  return lease.action === standBack && lease.amount > 0 ? lease.amount - 1 : undefined;
}

/** The pieces of the ways considered for a vehicle that its present one does not take any more. */
export function consideredLines(drawing: Drawing, leases: Lease[], { slot, way, at }: SeenWay, ways: number[][]): Point[][] {
  const ahead = (ways[way] ?? []).slice(at);
  return leases.filter(({ onSignal, target }) => !onSignal && target === slot).flatMap((lease) => {
    const considered = ways[consideredWay(lease) ?? -1] ?? [];
    return formerLines(drawing, considered.slice(Math.max(0, considered.indexOf(ahead[0] as number))), ahead, 0);
  });
}

/** Metres from the beginning of the edge where the change was made to the end of either way. */
function restOf(drawing: Drawing, way: number[], at: number): number {
  return lengthOf(way.slice(at).flatMap((edge) => middleOf(drawing, edge)));
}

function lengths(other_m: number, own_m: number): string {
  return `${other_m.toFixed(0)} m ahead instead of ${own_m.toFixed(0)} m`;
}

/** Why a way was changed: the reason of the policy that asked for it, or what the road was like. */
export function reasonOf(change: WayChange, track: Track): string {
  const asked = track.asked.of({ pane: 0, onSignal: false, number: change.slot }, change.time_s)
    .find(({ lease, to_s }) => lease.action === takeRoute && to_s >= change.time_s - leaseOver_s);
  const text = (number: number) => track.names.texts[number] ?? "?";
  if (asked !== undefined) return `${text(asked.lease.reason)} (${text(asked.lease.policy)})`;
  const former = new Set(track.names.ways[change.before]?.slice(change.at) ?? []);
  const isBlocked = track.blocksAt(change.time_s).some(({ edge }) => former.has(edge));
  return isBlocked ? "the road ahead was blocked (its crew, no policy)" : "no policy asked for it";
}

/** What is told of a way that was considered, without when. */
export function consideredText(lease: Lease, from_s: number, track: Track, drawing: Drawing): string | undefined {
  const considered = track.names.ways[consideredWay(lease) ?? -1];
  const present = track.names.ways[track.ways.at(lease.target, from_s) ?? -1];
  if (considered === undefined || present === undefined) return undefined;
  const from = Math.max(0, present.indexOf(considered[0] as number));
  const [other_m, own_m] = [restOf(drawing, considered, 0), restOf(drawing, present, from)];
  const text = (number: number) => track.names.texts[number] ?? "?";
  return `considered another way, ${lengths(other_m, own_m)}: ${text(lease.reason)} (${text(lease.policy)})`;
}

/** What is told of a change among the commands of its vehicle. */
export function changeText(change: WayChange, track: Track, drawing: Drawing): string {
  const way = (number: number) => track.names.ways[number] ?? [];
  const [before_m, after_m] = [restOf(drawing, way(change.before), change.at), restOf(drawing, way(change.after), change.at)];
  return `${change.time_s.toFixed(2)} s: took another way, ${lengths(after_m, before_m)}: ${reasonOf(change, track)}`;
}
