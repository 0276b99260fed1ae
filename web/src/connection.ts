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

const firstRetryMs = 500;
const lastRetryMs = 5000;

/** The WebSocket: comes back by itself when it is lost. */
export class Connection {
  /** Gets each picture; the next comes after drawn(). */
  onPicture: ((picture: Picture) => void) | null = null;
  private socket: WebSocket | null = null;
  private retryMs = firstRetryMs;
  private wantsImages = false;

  open(): void {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/live`);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.retryMs = firstRetryMs;
      store.set({ connection: "open" });
      if (this.wantsImages) this.send({ images: true });
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => void this.receive(event.data);
    socket.onclose = () => void this.lose();
  }

  wantImages(wanted: boolean): void {
    this.wantsImages = wanted;
    this.send({ images: wanted });
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
      store.receive(JSON.parse(data) as ServerMessage);
      return;
    }
    const receivedAt = performance.now();
    const { header, jpeg } = unpackImage(data);
    this.onPicture?.({ header, bitmap: await createImageBitmap(jpeg), receivedAt });
  }

  private async lose(): Promise<void> {
    store.set({ connection: "lost" });
    // A server that was started anew with another token does not know this browser.
    const answer = await fetch("/", { method: "HEAD" }).catch(() => null);
    if (answer?.status === 401) {
      store.set({ connection: "refused" });
      return;
    }
    setTimeout(() => this.open(), this.retryMs);
    this.retryMs = Math.min(2 * this.retryMs, lastRetryMs);
  }
}

export const connection = new Connection();
