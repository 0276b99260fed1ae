// SPDX-License-Identifier: BSD-3-Clause
import type { ColorRequest } from "./color_protocol";
import { unpackImage, type CommandName, type FrameHeader, type ServerMessage } from "./protocol";
import { store } from "./store";

/** A frame that can be drawn. */
export interface Picture {
  header: FrameHeader;
  bitmap: ImageBitmap;
  receivedAt: number;
}

/** Images in a view of hello, "": the camera's; held: of no other frame than the last. */
export interface ImageWish {
  view: string;
  isHeld: boolean;
}

const firstRetryMs = 500;
/** A connection that opens later is given up. */
const openMs = 5000;
const lastRetryMs = 5000;

/** The WebSocket: comes back by itself when it is lost. */
export class Connection {
  /** Gets each picture; the next comes after drawn(). */
  onPicture: ((picture: Picture) => void) | null = null;
  private socket: WebSocket | null = null;
  private retryMs = firstRetryMs;
  private openedAt = 0;
  /** The images that the server was asked for; null: none. */
  private imageWish: ImageWish | null = null;

  open(): void {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/live`);
    this.socket = socket;
    this.openedAt = performance.now();
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.retryMs = firstRetryMs;
      store.set({ connection: "open" });
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => void this.receive(event.data);
    socket.onclose = () => void this.lose();
  }

  /** Gives up a connection on which nothing comes any more. */
  renew(): void {
    const socket = this.socket;
    if (socket === null || performance.now() - this.openedAt < openMs) return;
    socket.onclose = socket.onmessage = null;
    socket.close();
    void this.lose();
  }

  /** Null: none. */
  wantImages(wish: ImageWish | null): void {
    this.imageWish = wish;
    if (wish === null) this.send({ images: false });
    else this.send({ images: wish.view === "" ? true : wish.view, hold: wish.isHeld });
  }

  drawn(header: FrameHeader): void {
    this.send({ ack: header.sequence });
  }

  command(name: CommandName, value?: number): void {
    this.send(value === undefined ? { command: name } : { command: name, value });
  }

  commandWith(name: CommandName, settings: string[]): void {
    this.send({ command: name, settings });
  }

  colors(request: ColorRequest): void {
    this.send(request);
  }

  private send(message: object): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  private async receive(data: string | ArrayBuffer): Promise<void> {
    if (typeof data === "string") {
      const message = JSON.parse(data) as ServerMessage;
      store.receive(message);
      if (message.kind === "hello") this.greet();
      return;
    }
    const receivedAt = performance.now();
    store.state.freshness.hear(receivedAt);
    const { header, jpeg } = unpackImage(data);
    const bitmap = await createImageBitmap(jpeg);
    if (this.onPicture) this.onPicture({ header, bitmap, receivedAt });
    else this.drawn(header); // nobody looks any more
  }

  // Only now is it known which views there are. A picture that is held stays: the server, which may
  // be another one, does not have its frame.
  private greet(): void {
    const wish = this.imageWish;
    if (wish === null || wish.isHeld) return;
    const isKnown = store.state.hello?.views.includes(wish.view) ?? false;
    this.wantImages(isKnown ? wish : { view: "", isHeld: false });
  }

  private async lose(): Promise<void> {
    this.socket = null;
    store.set({ connection: "lost" });
    // A server that was started anew with another token does not know this browser.
    const answer = await fetch("/", { method: "HEAD", signal: AbortSignal.timeout(openMs) }).catch(() => null);
    if (answer?.status === 401) {
      store.set({ connection: "refused" });
      return;
    }
    setTimeout(() => this.open(), this.retryMs);
    this.retryMs = Math.min(2 * this.retryMs, lastRetryMs);
  }
}

export const connection = new Connection();
