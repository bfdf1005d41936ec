// Starts the players of a page: those of a report, of a replay, or the one of a live run.

import { element } from "./controls";
import { type Drawing, readDrawing } from "./drawing";
import { startLive } from "./live";
import { unpacked } from "./packed";
import { followHash, Player } from "./player";
import { streamFormat } from "./stream";
import { adoptStyle } from "./style";
import { type About, Track } from "./track";

interface PlayData {
  title: string;
  note: string;
  drawing: number;
  followed: string;
  runs: { about: About; begin_s: number; end_s: number; stream: string }[];
}
interface PageData {
  format: number;
  drawings: string[];
  plays: PlayData[];
}

/** Plays by turns: one map at a time, so that a report with many holds one drawing context. */
class PlayChooser {
  private player: Player | undefined;
  private readonly drawings = new Map<number, Drawing>();

  constructor(
    private readonly place: HTMLElement,
    private readonly data: PageData,
  ) {}

  async start(): Promise<void> {
    if (this.data.format !== streamFormat)
      throw new Error(`the data is of format ${this.data.format}, this page reads ${streamFormat}`);
    if (this.data.plays.length > 1) this.place.append(this.menu());
    await this.play(0);
    const follow = () => this.player !== undefined && followHash(this.player);
    addEventListener("hashchange", follow);
    follow();
  }

  private menu(): HTMLElement {
    const label = element("label", "menu", "Trip ");
    const select = element("select");
    this.data.plays.forEach((play, i) => select.add(new Option(play.title, String(i))));
    select.addEventListener("change", () => void this.play(Number(select.value)).catch((error) => fail(this.place, error)));
    label.append(select);
    return label;
  }

  private async play(number: number): Promise<void> {
    const play = this.data.plays[number] as PlayData;
    const drawing = await this.drawing(play.drawing);
    const tracks = await Promise.all(
      play.runs.map(async (run) => {
        const track = new Track(run.about, drawing.quantum_m);
        track.append(await unpacked(run.stream));
        return track;
      }),
    );
    this.player?.end();
    this.player = new Player(drawing, tracks, { note: play.note, followed: play.followed });
    this.place.append(this.player.element);
    this.player.start();
    this.place.dataset.ready = "yes";
  }

  private async drawing(number: number): Promise<Drawing> {
    const known = this.drawings.get(number);
    if (known !== undefined) return known;
    const drawing = readDrawing(new TextDecoder().decode(await unpacked(this.data.drawings[number] as string)));
    this.drawings.set(number, drawing);
    return drawing;
  }
}

function fail(place: HTMLElement, error: unknown): void {
  place.append(element("p", "failure", `This cannot be shown: ${error instanceof Error ? error.message : String(error)}`));
  place.dataset.ready = "failed";
}

function start(place: HTMLElement): void {
  if (place.dataset.mode === "live") return startLive(place);
  const data = document.querySelector("script.clearway-plays");
  new PlayChooser(place, JSON.parse(data?.textContent ?? "{}") as PageData).start().catch((error) => fail(place, error));
}

adoptStyle();
for (const place of document.querySelectorAll<HTMLElement>(".clearway-player")) {
  place.replaceChildren();
  start(place);
}
