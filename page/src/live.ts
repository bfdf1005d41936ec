// A run that happens now: the same player, fed by a WebSocket of the server that sent this page.

import type { LiveControl } from "./clock";
import { element } from "./controls";
import { type Drawing, readDrawing } from "./drawing";
import { followHash, Player } from "./player";
import { streamFormat } from "./stream";
import { type About, Track } from "./track";

/** What the server says first. */
interface Welcome {
  format: number;
  allow_control: boolean;
  drawing: string;
  runs: About[];
}

/** What it says from time to time. */
interface Status {
  paused: boolean;
  speed: number;
  dropped: number;
  ended: boolean;
}

class LivePage {
  private readonly said = element("p", "status");
  private drawing: Drawing | undefined;
  private status: Status | undefined;
  private tracks: Track[] = [];
  private player: Player | undefined;
  private control = false;

  constructor(
    private readonly place: HTMLElement,
    private readonly socket: WebSocket,
  ) {
    this.said.setAttribute("role", "status");
    this.said.textContent = "Waiting for the run to begin.";
    place.append(this.said);
    socket.binaryType = "arraybuffer";
    socket.addEventListener("message", (event) => this.take(event.data as ArrayBuffer | string));
    socket.addEventListener("close", () => this.closed());
  }

  /** Text is JSON of the server; bytes are the number of a run and blocks of its stream. */
  private take(data: ArrayBuffer | string): void {
    try {
      if (typeof data === "string") return this.takeWords(JSON.parse(data) as Record<string, unknown>);
      const bytes = new Uint8Array(data);
      const track = this.tracks[bytes[0] as number];
      if (track === undefined) return;
      track.append(bytes.subarray(1));
      this.startWhenAllBegan();
      this.player?.arrived();
    } catch (error) {
      this.place.append(element("p", "failure", `The stream cannot be shown: ${String(error)}`));
      this.socket.close();
    }
  }

  private takeWords(words: Record<string, unknown>): void {
    if ("welcome" in words) return this.welcome(words.welcome as Welcome);
    if ("status" in words) this.showStatus(words.status as Status);
  }

  private welcome(welcome: Welcome): void {
    if (welcome.format !== streamFormat) throw new Error(`its format is ${welcome.format}, this page reads ${streamFormat}`);
    this.drawing = readDrawing(welcome.drawing);
    this.control = welcome.allow_control;
    this.tracks = welcome.runs.map((about) => new Track(about, (this.drawing as Drawing).quantum_m));
  }

  private startWhenAllBegan(): void {
    if (this.player !== undefined || this.drawing === undefined) return;
    if (this.tracks.length === 0 || this.tracks.some((track) => track.empty)) return;
    this.player = new Player(this.drawing, this.tracks, { note: "", followed: "", live: this.liveControl() });
    this.place.append(this.player.element);
    this.player.start();
    const { player } = this;
    addEventListener("hashchange", () => followHash(player));
    followHash(player);
    this.place.dataset.ready = "yes";
    if (this.status !== undefined) this.showStatus(this.status);
  }

  private liveControl(): LiveControl {
    const say = (words: object) => this.socket.send(JSON.stringify(words));
    return {
      allowed: this.control,
      pause: () => say({ do: "pause" }),
      go: () => say({ do: "go" }),
      step: () => say({ do: "step" }),
      speed: (times) => say({ do: "speed", times }),
    };
  }

  private showStatus(status: Status): void {
    this.status = status;
    if (status.ended) this.player?.over();
    else this.player?.follow(status.paused, status.speed);
    const lost = status.dropped === 0 ? "" : ` ${status.dropped} frames were left out because this page was too slow.`;
    const pace = status.paused ? "Paused." : status.speed === 0 ? "As fast as possible." : `At ${status.speed} times real time.`;
    this.said.textContent = (status.ended ? "The run is over; what was seen can be played again." : pace) + lost;
    this.place.dataset.dropped = String(status.dropped);
    this.place.dataset.ended = String(status.ended);
  }

  private closed(): void {
    if (this.status?.ended !== true) this.said.textContent += " The server has closed the connection.";
    this.player?.over();
    this.place.dataset.closed = "yes";
  }
}

export function startLive(place: HTMLElement): void {
  const address = new URL("stream", location.href);
  address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
  address.search = location.search;
  new LivePage(place, new WebSocket(address));
}

