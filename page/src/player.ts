// One play: its map, its clock and what one can do with them.

import { AskedPanel, type Thing } from "./asked";
import { button, choice, element, LeaseList, legend, toggle } from "./controls";
import { Curves } from "./curves";
import type { Drawing } from "./drawing";
import { type Camera, MapCanvas } from "./map";
import { Pane, type Shown } from "./pane";
import { describe, TimeLine } from "./timeline";
import type { Moment, Track } from "./track";
import { middleOf, reasonOf } from "./ways";

const speeds = [0.25, 0.5, 1, 2, 5, 10, 30];
const followZoom = 2.2;
/** Two live runs that are further apart are not in step any more: one of them is over, s. */
const inStep_s = 1.5;
/** Seconds that an arrow key moves the clock; with Shift ten times that. */
const keyStep_s = 1;

/** What a server allows, where the run happens now. */
export interface LiveControl {
  allowed: boolean;
  pause(): void;
  go(): void;
  step(): void;
  speed(times: number): void;
}

export interface PlayOptions {
  note: string;
  followed: string;
  live?: LiveControl;
}

function speedText(times: number): string {
  return times === 0 ? "as fast as possible" : `${times}×`;
}

function speedTexts(): { text: string; value: string }[] {
  return speeds.map((times) => ({ text: speedText(times), value: String(times) }));
}

export class Player {
  readonly element = element("div", "play");
  private readonly map: MapCanvas;
  private readonly timeLine: TimeLine;
  private readonly curves: Curves;
  private readonly leaseLists: LeaseList[];
  private readonly captions: HTMLElement[];
  private readonly clock = element("output", "clock");
  private readonly playButton: HTMLButtonElement;
  private readonly calm = matchMedia("(prefers-reduced-motion: reduce)");
  private readonly shown: Shown = { links: [false, false, true], ghosts: true, leases: true, ways: true, followed: [] };
  private readonly followBox: HTMLInputElement;
  private readonly askedPanel: AskedPanel;
  /** Id of the emergency vehicle to follow; empty for one that is on the road, whichever it is. */
  private wanted = "";
  private readonly wantedChoice: HTMLSelectElement;
  private followed: (number | undefined)[] = [];
  private camera: Camera = { x: 0, y: 0, zoom: 0 };
  private time_s: number;
  private speed = 5;
  private playing = false;
  /** Where the run happens now; no more once it is over. */
  private live: LiveControl | undefined;
  /** Whether the newest frame of a live run is shown, whatever comes. */
  private newest = true;
  private readonly speedChoice: HTMLSelectElement;
  private following = true;
  /** Whether a live run has shown no emergency vehicle yet: the view comes near when one enters. */
  private awaits = false;
  private last_ms = 0;
  private pending = 0;
  /** Pictures that were asked for, and those that were drawn: one may show what several asked for. */
  private asked = 0;
  private drawn = 0;
  private journeysAt_s = Number.NEGATIVE_INFINITY;
  private readonly ends: (() => void)[] = [];

  constructor(
    private readonly drawing: Drawing,
    private readonly tracks: Track[],
    private readonly options: PlayOptions,
  ) {
    this.live = options.live;
    this.time_s = this.live === undefined ? this.firstTime() : this.newest_s;
    this.timeLine = new TimeLine((time_s) => this.show(time_s));
    this.curves = new Curves((time_s) => this.show(time_s));
    this.leaseLists = tracks.map((track) => new LeaseList(track, (signal) => drawing.signals[signal]?.id ?? "?"));
    this.captions = tracks.map(() => element("div", "caption"));
    this.askedPanel = new AskedPanel(tracks, drawing);
    this.wanted = options.followed;
    const wanted = choice("Emergency vehicle", [{ text: "any on the road", value: "" }], "", (id) => this.want(id));
    this.wantedChoice = wanted.querySelector("select") as HTMLSelectElement;
    this.wantedChoice.setAttribute("aria-label", "Emergency vehicle to follow");
    this.listEmergency();
    this.playButton = button("▶", "Play or pause (space)", () => this.togglePlay());
    const speed = choice("Speed", speedTexts(), String(this.speed), (value) => this.setSpeed(Number(value)));
    this.speedChoice = speed.querySelector("select") as HTMLSelectElement;
    const follow = toggle("follow the emergency vehicle", true, (on) => this.setFollowing(on));
    this.followBox = follow.querySelector("input") as HTMLInputElement;
    const place = this.build(speed, follow, wanted);
    this.map = new MapCanvas(place, drawing, tracks.map((track, i) => new Pane(i, track, drawing)), {
      moved: (camera) => this.moveTo(camera),
      drawn: () => {
        this.element.dataset.drawn = String(++this.drawn);
        this.element.dataset.shown = this.element.dataset.asked;
      },
      failed: (why) => this.fail(why),
    });
    this.listen(place);
  }

  /** To be called once the element is in the page. */
  start(): void {
    this.map.layOut();
    this.camera = this.map.whole();
    this.chooseFollowed();
    this.awaits = this.live !== undefined;
    if (this.followed.some((slot) => slot !== undefined)) this.comeNear();
    this.refreshCurves(true);
    this.draw();
    if (this.live !== undefined) this.play(true);
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
    this.draw();
  }

  /** From now on this is the replay of what was seen. */
  over(): void {
    if (this.live === undefined) return;
    this.live = undefined;
    this.play(false);
    if (this.speed === 0) this.chooseSpeed(5);
    this.refreshCurves(true);
    this.draw();
  }

  end(): void {
    cancelAnimationFrame(this.pending);
    for (const end of this.ends) end();
    this.curves.end();
    this.map.end();
    this.element.remove();
  }

  /** Shows a moment, and nothing else moves. */
  show(time_s: number): void {
    this.play(false);
    this.time_s = this.clamped(time_s);
    this.newest = this.time_s >= this.newest_s - 1e-6;
    this.draw();
  }

  /** Shows a place; the view follows nobody any more. */
  look(camera: Camera): void {
    this.awaits = false;
    this.setFollowing(false);
    this.camera = camera;
    this.draw();
  }

  private get begin_s(): number {
    return Math.min(...this.tracks.map((track) => track.begin_s));
  }
  private get end_s(): number {
    return Math.max(...this.tracks.map((track) => track.end_s));
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

  private build(speed: HTMLElement, follow: HTMLElement, wanted: HTMLElement): HTMLElement {
    const panes = element("div", `panes of-${this.tracks.length}`);
    const place = element("div", "map");
    place.tabIndex = 0;
    place.setAttribute("role", "application");
    place.setAttribute(
      "aria-label",
      "Map of the run. Space plays, arrows move the time, plus and minus zoom, F follows the emergency vehicle, " +
        "N goes to the next one, C to the next vehicle or signal that is asked something.",
    );
    panes.append(place, ...this.captions);
    this.element.append(panes, this.controls(speed, follow, wanted), this.timeLine.element, this.layerSwitches());
    this.element.append(this.askedPanel.element, this.curves.element);
    const leases = element("div", "lease-lists");
    leases.append(...this.leaseLists.map((list) => list.element));
    this.element.append(leases, legend(this.tracks.some(({ about }) => about.incidents.length > 0)));
    if (this.options.note !== "") this.element.append(element("p", "note", this.options.note));
    return place;
  }

  private controls(speed: HTMLElement, follow: HTMLElement, wanted: HTMLElement): HTMLElement {
    const row = element("div", "controls");
    const { live } = this.options;
    row.append(this.playButton);
    row.append(button("‹", "One frame back (comma)", () => this.step(-1)));
    row.append(button("›", "One frame on (full stop)", () => this.step(1)));
    if (live === undefined || live.allowed) row.append(speed);
    row.append(this.clock, wanted, follow);
    row.append(button("+", "Nearer (plus)", () => this.zoom(0.5)), button("−", "Farther (minus)", () => this.zoom(-0.5)));
    row.append(button("whole", "The whole network (W)", () => this.look(this.map.whole())));
    row.append(button("its way", "The way ahead of the emergency vehicle, and the one that it left (V)", () => this.lookAtWays()));
    if (live !== undefined && !live.allowed)
      row.append(element("span", "hint", "This page only watches: the server was started without --allow-control."));
    return row;
  }

  private layerSwitches(): HTMLElement {
    const row = element("div", "layers");
    const texts = ["true links", "observed links", "believed links"];
    for (const kind of [0, 1, 2] as const) {
      row.append(
        toggle(texts[kind] as string, this.shown.links[kind], (on) => {
          this.shown.links[kind] = on;
          this.draw();
        }),
      );
    }
    for (const [text, what] of [["ghosts", "ghosts"], ["leases", "leases"], ["way", "ways"]] as const) {
      row.append(
        toggle(text, this.shown[what], (on) => {
          this.shown[what] = on;
          this.draw();
        }),
      );
    }
    return row;
  }

  private listen(place: HTMLElement): void {
    const on = (target: EventTarget, name: string, act: (event: Event) => void, options?: AddEventListenerOptions) => {
      target.addEventListener(name, act, options);
      this.ends.push(() => target.removeEventListener(name, act, options));
    };
    on(place, "keydown", (event) => this.key(event as KeyboardEvent));
    let pressed: [number, number] = [0, 0];
    on(place, "pointerdown", (event) => (pressed = spotOf(event as PointerEvent)), { capture: true });
    on(place, "click", (event) => this.click(spotOf(event as MouseEvent), pressed, place));
    on(place, "wheel", (event) => this.wheel(event as WheelEvent), { passive: false });
    const again = () => {
      this.map.recolour();
      this.refreshCurves(true);
      this.draw();
    };
    on(matchMedia("(prefers-color-scheme: dark)"), "change", again);
    on(matchMedia("print"), "change", again);
    const sizes = new ResizeObserver(() => {
      this.map.layOut();
      this.curves.resize();
      this.draw();
    });
    sizes.observe(this.element);
    this.ends.push(() => sizes.disconnect());
  }

  private key(event: KeyboardEvent): void {
    const far = event.shiftKey ? 10 : 1;
    const acts: Record<string, () => void> = {
      " ": () => this.togglePlay(),
      ArrowLeft: () => this.show(this.time_s - far * keyStep_s),
      ArrowRight: () => this.show(this.time_s + far * keyStep_s),
      Home: () => this.show(this.begin_s),
      End: () => this.show(this.end_s),
      ",": () => this.step(-1),
      ".": () => this.step(1),
      "+": () => this.zoom(0.5),
      "=": () => this.zoom(0.5),
      "-": () => this.zoom(-0.5),
      f: () => this.setFollowing(!this.following),
      w: () => this.look(this.map.whole()),
      v: () => this.lookAtWays(),
      n: () => this.wantNext(1),
      N: () => this.wantNext(-1),
      c: () => this.chooseNext(),
      Escape: () => this.choose(undefined),
    };
    const act = event.ctrlKey || event.metaKey || event.altKey ? undefined : acts[event.key];
    if (act === undefined) return;
    event.preventDefault();
    act();
  }

  /** A page scrolls over its maps; with Ctrl or after a click into the map the wheel zooms. */
  private wheel(event: WheelEvent): void {
    if (!event.ctrlKey && document.activeElement !== event.currentTarget) return;
    event.preventDefault();
    this.zoom(event.deltaY < 0 ? 0.25 : -0.25);
  }

  /** A click that moved the map chooses nothing. */
  private click(at: [number, number], pressed: [number, number], place: HTMLElement): void {
    if (Math.hypot(at[0] - pressed[0], at[1] - pressed[1]) > 5) return;
    const box = place.getBoundingClientRect();
    this.choose(this.map.thingAt(at[0] - box.left - place.clientLeft, at[1] - box.top - place.clientTop));
  }

  private choose(thing: Thing | undefined): void {
    if (thing === undefined) delete this.shown.chosen;
    else this.shown.chosen = thing;
    this.draw();
  }

  /** The next of those that something is asked of now, over all runs. */
  private chooseNext(): void {
    const things = this.tracks.flatMap((track, pane) => {
      const targets = track.at(this.time_s).now.leases.map(({ onSignal, target }) => ({ pane, onSignal, number: target }));
      return targets.filter((one, i) => targets.findIndex((other) => same(one, other)) === i);
    });
    if (things.length === 0) return;
    const { chosen } = this.shown;
    const last = chosen === undefined ? -1 : things.findIndex((thing) => same(thing, chosen));
    this.choose(things[(last + 1) % things.length]);
  }

  /** The emergency vehicles of all runs by id, with the time at which each first enters. */
  private emergency(): Map<string, number> {
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
  private listEmergency(): void {
    const entries = this.emergency();
    if (this.wantedChoice.length === entries.size + 1) return;
    for (const [id, from_s] of [...entries].slice(this.wantedChoice.length - 1))
      this.wantedChoice.add(new Option(`${id}, from ${from_s.toFixed(0)} s`, id));
    this.wantedChoice.value = this.wanted;
  }

  /** Follows an emergency vehicle, in a replay from its departure on if it is not on the road now. */
  private want(id: string): void {
    this.wanted = id;
    this.wantedChoice.value = id;
    const isHere = (track: Track) => track.emergency.some(
      (slot) => track.names.vehicles[slot]?.id === id && track.at(this.time_s).now.rowOf(slot) >= 0,
    );
    const from_s = this.emergency().get(id);
    if (from_s !== undefined && !this.tracks.some(isHere)) this.show(from_s);
    this.setFollowing(true);
    this.comeNear();
    this.draw();
  }

  private wantNext(by: 1 | -1): void {
    const ids = [...this.emergency()].sort((one, other) => one[1] - other[1]).map(([id]) => id);
    if (ids.length === 0) return;
    const slot = this.followed[0];
    const now = this.wanted !== "" ? this.wanted : slot === undefined ? "" : (this.tracks[0]?.names.vehicles[slot]?.id ?? "");
    this.want(ids[(ids.indexOf(now) + by + ids.length) % ids.length] as string);
  }

  private comeNear(): void {
    this.awaits = false;
    this.camera = { ...this.camera, zoom: Math.max(this.camera.zoom, followZoom) };
  }

  /** An emergency vehicle may enter after the page was opened; who has chosen a view keeps it. */
  private comeNearWho(moments: Moment[]): void {
    const enters = (slot: number | undefined, i: number) => slot !== undefined && (moments[i] as Moment).now.rowOf(slot) >= 0;
    if (this.awaits && this.following && this.followed.some(enters)) this.comeNear();
  }

  private zoom(by: number): void {
    this.awaits = false;
    this.camera = { ...this.camera, zoom: Math.min(6, Math.max(-8, this.camera.zoom + by)) };
    this.draw();
  }

  private moveTo(camera: Camera): void {
    this.awaits = false;
    this.setFollowing(false);
    this.camera = camera;
    this.draw();
  }

  private setFollowing(on: boolean): void {
    this.following = on;
    this.followBox.checked = on;
    this.draw();
  }

  /** Shows what lies ahead of the followed vehicles, and the ways that they left a moment ago. */
  private lookAtWays(): void {
    const places = this.tracks.flatMap((track, i) => {
      const { now } = track.at(this.time_s);
      const seen = now.ways.find(({ slot }) => slot === this.followed[i]);
      if (seen === undefined) return [];
      const change = track.ways.shown(seen.slot, now.time_s);
      const ahead = (way: number, at: number) => (track.names.ways[way] ?? []).slice(at);
      const former = change === undefined ? [] : ahead(change.before, change.at);
      return [...ahead(seen.way, seen.at), ...former].flatMap((edge) => middleOf(this.drawing, edge));
    });
    const margin_m = 40;
    if (places.length > 0) this.look(this.map.around(places, margin_m));
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

  private step(direction: -1 | 1): void {
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

  private nextOf(times: number[]): number {
    const later = times.filter((time) => time > this.time_s + 1e-6);
    return later.length === 0 ? this.end_s : Math.min(...later);
  }

  private togglePlay(): void {
    const { live } = this;
    if (live?.allowed === true) this.playing ? live.pause() : live.go();
    if (live !== undefined) this.newest = live.allowed || !this.playing;
    else if (!this.playing && this.time_s >= this.end_s - 1e-6) this.time_s = this.begin_s;
    this.play(!this.playing);
    if (live?.allowed === true) this.arrived();
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
      this.refreshCurves(false);
      this.last_ms = now_ms;
      this.draw();
    } else if (!this.calm.matches || passed_s >= 1) {
      // With reduced motion the picture changes once a simulated second and nothing glides.
      this.time_s = this.clamped(this.time_s + (this.calm.matches ? Math.floor(passed_s) : passed_s));
      this.last_ms = now_ms;
      this.draw();
    }
    if (this.live === undefined && this.time_s >= this.end_s) return this.play(false);
    this.pending = requestAnimationFrame(() => this.tick());
  }

  /** The wanted vehicle; without one that which is followed already, or another that is on the road. */
  private chooseFollowed(): void {
    const before = this.followed;
    this.followed = this.tracks.map((track, i) => {
      const named = track.emergency.find((slot) => track.names.vehicles[slot]?.id === this.wanted);
      if (named !== undefined) return named;
      const { now } = track.at(this.time_s);
      const isHere = (slot: number | undefined) => slot !== undefined && now.rowOf(slot) >= 0;
      return isHere(before[i]) ? before[i] : (track.emergency.find(isHere) ?? before[i] ?? track.emergency[0]);
    });
    this.listEmergency();
    this.shown.followed = this.followed;
    if (this.followed.some((slot, i) => slot !== before[i])) this.refreshCurves(true);
  }

  /** In a live run the curves grow: they are drawn anew every five seconds of it. */
  private refreshCurves(always: boolean): void {
    if (!always && this.end_s < this.journeysAt_s + 5) return;
    this.journeysAt_s = this.end_s;
    this.curves.show(this.tracks, this.followed);
  }

  private draw(): void {
    this.chooseFollowed();
    const moments = this.tracks.map((track) => track.at(this.time_s));
    if (this.calm.matches) moments.forEach((moment) => (moment.share = 0));
    this.comeNearWho(moments);
    this.element.dataset.asked = String(++this.asked);
    this.map.draw(moments, this.cameras(moments), this.shown);
    this.timeLine.show(this.time_s, this.begin_s, this.end_s, this.tracks);
    this.curves.at(this.time_s);
    this.askedPanel.show(this.shown.chosen, moments);
    this.clock.value = `${this.time_s.toFixed(2)} s`;
    this.tracks.forEach((track, i) => this.captionOf(track, i, moments[i] as Moment));
    this.element.dataset.time = this.time_s.toFixed(3);
    this.element.dataset.zoom = this.camera.zoom.toFixed(3);
  }

  private cameras(moments: Moment[]): Camera[] {
    return this.tracks.map((_, i) => {
      const at = this.following ? this.placeOfFollowed(i, moments[i] as Moment) : undefined;
      return at === undefined ? this.camera : { ...this.camera, x: at[0], y: at[1] };
    });
  }

  private placeOfFollowed(i: number, { now, next, share }: Moment): [number, number] | undefined {
    const slot = this.followed[i];
    if (slot === undefined) return undefined;
    const { quantum_m } = this.drawing;
    const row = now.rowOf(slot);
    if (row < 0) return this.lastPlaces[i];
    const then = next.rowOf(slot);
    const x = now.x[row] as number;
    const y = now.y[row] as number;
    const to = then < 0 ? [x, y] : [next.x[then] as number, next.y[then] as number];
    this.lastPlaces[i] = [
      (x + ((to[0] as number) - x) * share) * quantum_m,
      (y + ((to[1] as number) - y) * share) * quantum_m,
    ];
    return this.lastPlaces[i];
  }
  private readonly lastPlaces: ([number, number] | undefined)[] = [];

  private captionOf(track: Track, i: number, { now }: Moment): void {
    const slot = this.followed[i];
    const row = slot === undefined ? -1 : now.rowOf(slot);
    const speed = row < 0 ? "" : `, ${(((now.speed[row] as number) / 10) * 3.6).toFixed(0)} km/h`;
    const state = row >= 0 ? "" : `, ${this.absence(track, slot, now.time_s)}`;
    const id = slot === undefined ? "no emergency vehicle yet" : (track.names.vehicles[slot]?.id ?? "?");
    const caption = this.captions[i] as HTMLElement;
    const change = row < 0 ? undefined : track.ways.shown(slot as number, now.time_s);
    const turned = change === undefined ? "" : `, another way since ${change.time_s.toFixed(0)} s: ${reasonOf(change, track)}`;
    const text = `${track.about.condition}: ${id}${speed}${state}${turned}; ${now.count} vehicles`;
    if (caption.textContent !== text) caption.textContent = text;
    caption.title = describe(track);
    (this.leaseLists[i] as LeaseList).show(now);
  }

  /** Why a vehicle is not on the road. Of a live run the newest frame is not the end, unless the others went on. */
  private absence(track: Track, slot: number | undefined, time_s: number): string {
    const isOver = this.live === undefined ? time_s >= track.end_s - 1e-6 : track.end_s < this.end_s - inStep_s;
    if (isOver) return "run over";
    const from_s = slot === undefined ? undefined : track.journey(slot).time_s[0];
    if (from_s === undefined) return "the run goes on";
    return time_s < from_s ? `enters at ${from_s.toFixed(0)} s` : "not on the road any more";
  }

  private fail(why: string): void {
    if (this.element.querySelector(".failure") !== null) return;
    this.element.prepend(element("p", "failure", `The map cannot be drawn: ${why}. It needs WebGL 2.`));
  }
}

function spotOf(event: MouseEvent): [number, number] {
  return [event.clientX, event.clientY];
}

function same(one: Thing, other: Thing): boolean {
  return one.pane === other.pane && one.onSignal === other.onSignal && one.number === other.number;
}

/** `#time=61.5&x=120&y=40&zoom=3`: a moment and a place (m from the lower left corner). */
export function followHash(player: Player): void {
  const words = new URLSearchParams(location.hash.slice(1));
  const number = (name: string) => (words.has(name) ? Number(words.get(name)) : Number.NaN);
  const [x, y, zoom, time_s] = [number("x"), number("y"), number("zoom"), number("time")];
  if (Number.isFinite(time_s)) player.show(time_s);
  if (Number.isFinite(x) && Number.isFinite(y) && Number.isFinite(zoom)) player.look({ x, y, zoom });
}
