// SPDX-License-Identifier: BSD-3-Clause
// What a pilot changes in the field. The program saves it for its next start.
import { connection } from "./connection";

export interface Setting {
  /** In `kestrel config`. */
  name: string;
  label: string;
  /** That the next start would use. */
  value: string;
  unit: string;
  meaning: string;
  /** Empty: any value of its kind. */
  choices: string[];
  /** On the command line, whose value holds over the file's. */
  given: boolean;
}

export interface Settings {
  kind: "settings";
  /** That they are saved to; empty: none was given to the program. */
  file: string;
  settings: Setting[];
  /** What was done with the last change; empty: nothing yet. */
  saved: string;
  /** Why it was refused. */
  error: string;
}

/** What is to be saved, as "name=value"; 'inputs': what was typed, by name. */
export function changesIn(settings: Setting[], inputs: Record<string, string>): string[] {
  return settings
    .filter(({ name, value, given }) => !given && inputs[name] !== undefined && inputs[name]?.trim() !== value)
    .map(({ name }) => `${name}=${inputs[name]?.trim()}`);
}

export function saveSettings(changes: string[]): void {
  connection.commandWith("settings", changes);
}
