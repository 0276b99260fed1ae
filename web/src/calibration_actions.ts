// SPDX-License-Identifier: BSD-3-Clause
import { isOffered } from "./actions";
import { wordsOf, type Subject } from "./calibration";
import { connection } from "./connection";

export function calibrate(subject: Subject, isMoving: boolean): void {
  if (isOffered("calibrate")) connection.commandWith("calibrate", wordsOf(subject, isMoving));
}

export function cancelCalibration(): void {
  connection.command("calibrate-cancel");
}

export function saveCalibration(): void {
  connection.command("calibrate-save");
}
