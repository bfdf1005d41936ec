// One play: its map, its clock and what one can do with them.

import { AskedPanel, nextAsked, type Thing } from "./asked";
import { Clock, type LiveControl } from "./clock";
import { button, element, layerSwitches, legend } from "./controls";
import { Curves } from "./curves";
import type { Drawing } from "./drawing";
import { Caption, Followed } from "./followed";
import { type Camera, MapCanvas } from "./map";
import { Pane, type Shown } from "./pane";
import { TimeLine } from "./timeline";
import type { Moment, Track } from "./track";
import { View } from "./view";

/** Seconds that an arrow key moves the clock; with Shift ten times that. */
const keyStep_s = 1;

export interface PlayOptions {
  note: string;
  followed: string;
  live?: LiveControl;
}

export class Player {
  readonly element = element("div", "play");
  private readonly clock: Clock;
  private readonly view: View;
  private readonly followed: Followed;
  private readonly map: MapCanvas;
  private readonly timeLine: TimeLine;
  private readonly curves: Curves;
  private readonly captions: Caption[];
  private readonly time = element("output", "clock");
  private readonly shown: Shown = { links: [false, false, true], ghosts: true, leases: true, ways: true, followed: [] };
  private readonly askedPanel: AskedPanel;
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
    this.clock = new Clock(tracks, options.live, { moved: () => this.draw(), grown: (over) => this.refreshCurves(over) });
    this.view = new View(drawing.quantum_m, () => this.draw());
    this.followed = new Followed(tracks, options.followed, (id) => this.want(id));
    this.timeLine = new TimeLine((time_s) => this.show(time_s));
    this.curves = new Curves((time_s) => this.show(time_s));
    this.captions = tracks.map((track) => new Caption(track, drawing));
    this.askedPanel = new AskedPanel(tracks, drawing);
    const place = this.build();
    this.map = new MapCanvas(place, drawing, tracks.map((track, i) => new Pane(i, track, drawing)), {
      moved: (camera) => this.look(camera),
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
    this.view.start(this.map.whole(), this.clock.isLive);
    this.chooseFollowed();
    if (this.followed.isAny) this.view.comeNear();
    this.refreshCurves(true);
    this.draw();
    this.clock.start();
  }

  /** What the server of a live run says: whether the runs wait, and their pace. */
  follow(paused: boolean, speed: number): void {
    this.clock.follow(paused, speed);
  }

  /** A live run has gone on. */
  arrived(): void {
    this.clock.arrived();
  }

  /** From now on this is the replay of what was seen. */
  over(): void {
    this.clock.over();
  }

  end(): void {
    this.clock.end();
    for (const end of this.ends) end();
    this.curves.end();
    this.map.end();
    this.element.remove();
  }

  /** Shows a moment, and nothing else moves. */
  show(time_s: number): void {
    this.clock.show(time_s);
  }

  /** Shows a place; the view follows nobody any more. */
  look(camera: Camera): void {
    this.view.look(camera);
  }

  private build(): HTMLElement {
    const panes = element("div", `panes of-${this.tracks.length}`);
    const place = element("div", "map");
    place.tabIndex = 0;
    place.setAttribute("role", "application");
    place.setAttribute(
      "aria-label",
      "Map of the run. Space plays, arrows move the time, plus and minus zoom, F follows the emergency vehicle, " +
        "N goes to the next one, C to the next vehicle or signal that is asked something.",
    );
    panes.append(place, ...this.captions.map((caption) => caption.element));
    this.element.append(panes, this.controls(), this.timeLine.element, layerSwitches(this.shown, () => this.draw()));
    this.element.append(this.askedPanel.element, this.curves.element);
    const leases = element("div", "lease-lists");
    leases.append(...this.captions.map((caption) => caption.leases.element));
    this.element.append(leases, legend(this.tracks.some(({ about }) => about.incidents.length > 0)));
    if (this.options.note !== "") this.element.append(element("p", "note", this.options.note));
    return place;
  }

  private controls(): HTMLElement {
    const row = element("div", "controls");
    const { live } = this.options;
    row.append(this.clock.playButton);
    row.append(button("‹", "One frame back (comma)", () => this.clock.step(-1)));
    row.append(button("›", "One frame on (full stop)", () => this.clock.step(1)));
    if (live === undefined || live.allowed) row.append(this.clock.speedLabel);
    row.append(this.time, this.followed.element, this.view.followLabel);
    row.append(button("+", "Nearer (plus)", () => this.view.zoom(0.5)), button("−", "Farther (minus)", () => this.view.zoom(-0.5)));
    row.append(button("whole", "The whole network (W)", () => this.look(this.map.whole())));
    row.append(button("its way", "The way ahead of the emergency vehicle, and the one that it left (V)", () => this.lookAtWays()));
    if (live !== undefined && !live.allowed)
      row.append(element("span", "hint", "This page only watches: the server was started without --allow-control."));
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
    const { clock, view } = this;
    const far = event.shiftKey ? 10 : 1;
    const acts: Record<string, () => void> = {
      " ": () => clock.togglePlay(),
      ArrowLeft: () => this.show(clock.time_s - far * keyStep_s),
      ArrowRight: () => this.show(clock.time_s + far * keyStep_s),
      Home: () => this.show(clock.begin_s),
      End: () => this.show(clock.end_s),
      ",": () => clock.step(-1),
      ".": () => clock.step(1),
      "+": () => view.zoom(0.5),
      "=": () => view.zoom(0.5),
      "-": () => view.zoom(-0.5),
      f: () => view.toggleFollowing(),
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
    this.view.zoom(event.deltaY < 0 ? 0.25 : -0.25);
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

  private chooseNext(): void {
    const next = nextAsked(this.tracks, this.clock.time_s, this.shown.chosen);
    if (next !== undefined) this.choose(next);
  }

  /** Follows an emergency vehicle, in a replay from its departure on if it is not on the road now. */
  private want(id: string): void {
    const from_s = this.followed.want(id, this.clock.time_s);
    if (from_s !== undefined) this.show(from_s);
    this.view.setFollowing(true);
    this.view.comeNear();
    this.draw();
  }

  private wantNext(by: 1 | -1): void {
    const id = this.followed.beside(by);
    if (id !== undefined) this.want(id);
  }

  private lookAtWays(): void {
    const places = this.followed.placesAhead(this.clock.time_s, this.drawing);
    const margin_m = 40;
    if (places.length > 0) this.look(this.map.around(places, margin_m));
  }

  private chooseFollowed(): void {
    const changed = this.followed.choose(this.clock.time_s);
    this.shown.followed = this.followed.slots;
    if (changed) this.refreshCurves(true);
  }

  /** In a live run the curves grow: they are drawn anew every five seconds of it. */
  private refreshCurves(always: boolean): void {
    const { end_s } = this.clock;
    if (!always && end_s < this.journeysAt_s + 5) return;
    this.journeysAt_s = end_s;
    this.curves.show(this.tracks, this.followed.slots);
  }

  private draw(): void {
    this.chooseFollowed();
    const { clock, view } = this;
    const { slots } = this.followed;
    const { time_s } = clock;
    const moments = this.tracks.map((track) => track.at(time_s));
    if (clock.calm.matches) moments.forEach((moment) => (moment.share = 0));
    view.comeNearWho(slots, moments);
    this.element.dataset.asked = String(++this.asked);
    this.map.draw(moments, view.cameras(slots, moments), this.shown);
    this.timeLine.show(time_s, clock.begin_s, clock.end_s, this.tracks);
    this.curves.at(time_s);
    this.askedPanel.show(this.shown.chosen, moments);
    this.time.value = `${time_s.toFixed(2)} s`;
    this.tracks.forEach((track, i) => {
      const { now } = moments[i] as Moment;
      (this.captions[i] as Caption).show(slots[i], now, clock.isOver(track, now.time_s));
    });
    this.element.dataset.time = time_s.toFixed(3);
    this.element.dataset.zoom = view.camera.zoom.toFixed(3);
  }

  private fail(why: string): void {
    if (this.element.querySelector(".failure") !== null) return;
    this.element.prepend(element("p", "failure", `The map cannot be drawn: ${why}. It needs WebGL 2.`));
  }
}

function spotOf(event: MouseEvent): [number, number] {
  return [event.clientX, event.clientY];
}

/** `#time=61.5&x=120&y=40&zoom=3`: a moment and a place (m from the lower left corner). */
export function followHash(player: Player): void {
  const words = new URLSearchParams(location.hash.slice(1));
  const number = (name: string) => (words.has(name) ? Number(words.get(name)) : Number.NaN);
  const [x, y, zoom, time_s] = [number("x"), number("y"), number("zoom"), number("time")];
  if (Number.isFinite(time_s)) player.show(time_s);
  if (Number.isFinite(x) && Number.isFinite(y) && Number.isFinite(zoom)) player.look({ x, y, zoom });
}
