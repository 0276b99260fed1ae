// SPDX-License-Identifier: BSD-3-Clause
import { isOffered } from "./actions";
import { connection } from "./connection";

/** Reads the table of two configurations, by their numbers; again where they are those that are shown. */
export function compareVariants(before: number, after: number): void {
  if (isOffered("compare")) connection.commandWith("compare", [String(before), String(after)]);
}

/** Replays a row of the table, by its number. */
export function openRow(number: number): void {
  if (isOffered("open")) connection.command("open", number);
}
