// Small pieces of the page: buttons, switches, a list of what is in force.

import { actionText, reasonText } from "./asked";
import type { Shown } from "./pane";
import type { FrameState, Lease } from "./stream";
import type { Track } from "./track";

/** An element with a class and text. Text is never markup. */
export function element<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  className = "",
  text = "",
): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  if (className !== "") made.className = className;
  if (text !== "") made.textContent = text;
  return made;
}

export function button(text: string, label: string, pressed: () => void): HTMLButtonElement {
  const made = element("button", "", text);
  made.type = "button";
  made.setAttribute("aria-label", label);
  made.title = label;
  made.addEventListener("click", pressed);
  return made;
}

export function toggle(text: string, on: boolean, changed: (on: boolean) => void): HTMLLabelElement {
  const label = element("label");
  const box = element("input");
  box.type = "checkbox";
  box.checked = on;
  box.addEventListener("change", () => changed(box.checked));
  label.append(box, ` ${text}`);
  return label;
}

export function choice(
  label: string,
  options: { text: string; value: string }[],
  chosen: string,
  changed: (value: string) => void,
): HTMLLabelElement {
  const made = element("label", "", `${label} `);
  const select = element("select");
  for (const option of options) select.add(new Option(option.text, option.value, false, option.value === chosen));
  select.addEventListener("change", () => changed(select.value));
  made.append(select);
  return made;
}

/** Alternatives of traffic::Action, in their order. */
export const actions = [
  "drive at", "change to lane", "hold lane", "pull aside", "give way at the stop line", "hold green", "adjust green",
  "pass red", "nothing: this is no case for it", "take another way",
];

function leaseText(lease: Lease, track: Track, signalId: (signal: number) => string): string {
  const target = lease.onSignal ? `signal ${signalId(lease.target)}` : (track.names.vehicles[lease.target]?.id ?? "?");
  return `${target}: ${actionText(lease)}${reasonText(lease, track)}`;
}

const mostListed = 12;

/** What is in force now, in words. */
export class LeaseList {
  readonly element = element("div", "leases");
  private readonly title = element("h4");
  private readonly list = element("ul");
  private written: Lease[] | undefined;

  constructor(
    private readonly track: Track,
    private readonly signalId: (signal: number) => string,
  ) {
    this.element.append(this.title, this.list);
  }

  show(state: FrameState): void {
    if (state.leases === this.written) return;
    this.written = state.leases;
    this.title.textContent = `${this.track.title}: ${state.leases.length} ${state.leases.length === 1 ? "lease" : "leases"} in force`;
    this.list.replaceChildren(
      ...state.leases.slice(0, mostListed).map((lease) => element("li", "", leaseText(lease, this.track, this.signalId))),
    );
    const more = state.leases.length - mostListed;
    if (more > 0) this.list.append(element("li", "", `and ${more} more`));
  }
}

/** Which of its layers the map shows: changes `shown` and says so. */
export function layerSwitches(shown: Shown, changed: () => void): HTMLElement {
  const row = element("div", "layers");
  const texts = ["true links", "observed links", "believed links"];
  for (const kind of [0, 1, 2] as const) {
    row.append(
      toggle(texts[kind] as string, shown.links[kind], (on) => {
        shown.links[kind] = on;
        changed();
      }),
    );
  }
  for (const [text, what] of [["ghosts", "ghosts"], ["leases", "leases"], ["way", "ways"]] as const) {
    row.append(
      toggle(text, shown[what], (on) => {
        shown[what] = on;
        changed();
      }),
    );
  }
  return row;
}

/** What the map's colours and shapes mean. */
export function legend(hasBlocks: boolean): HTMLElement {
  const made = element("ul", "legend");
  const entries: [string, string][] = [
    ["human", "human driver (box)"],
    ["automated", "automated (pointed)"],
    ["emergency", "emergency vehicle (arrow)"],
    ["dark-vehicle", "hollow: its last report did not arrive"],
    ["ghost", "where it is believed to be, with one sigma"],
    ["way", "way ahead of the emergency vehicle"],
    ["former-way", "the way that it left"],
    ["considered-way", "a way considered, not taken"],
    ["lease", "a lease acts here"],
    ["chosen", "chosen: what it was asked is below"],
    ["true-link", "true link"],
    ["observed-link", "observed link"],
    ["believed-link", "believed link"],
    ["request", "green requested"],
    ["grant", "green granted"],
    ["braking", "emergency braking"],
    ["collision", "collision"],
    ["way-changed", "another way taken"],
  ];
  if (hasBlocks) entries.unshift(["block", "road blocked"], ["unknown-block", "road blocked, not known yet"]);
  for (const [sign, text] of entries) {
    const entry = element("li");
    entry.append(element("span", `sign ${sign}`), ` ${text}`);
    made.append(entry);
  }
  return made;
}
