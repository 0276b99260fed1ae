// SPDX-License-Identifier: BSD-3-Clause
import { connection } from "./connection";
import { boardText, type BoardForm } from "./lens";

/** 'model': of the distortion; "" for the one that fits best. */
export function beginLens(form: BoardForm, model: string): void {
  connection.commandWith("lens", [boardText(form), model]);
}

export function stopLens(): void {
  connection.command("lens-stop");
}

export function saveLens(name: string, mayReplace: boolean): void {
  connection.commandWith("lens-save", mayReplace ? [name, "replace"] : [name]);
}
