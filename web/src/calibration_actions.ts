// SPDX-License-Identifier: BSD-3-Clause
import { isOffered } from "./actions";
import { wordsOf, type Subject } from "./calibration";
import { connection } from "./connection";
import { store, type Page } from "./store";

export function showPage(page: Page): void {
  store.set({ page });
}

export function toggleCalibrationPage(): void {
  showPage(store.state.page === "calibration" ? "watch" : "calibration");
}

export function calibrate(subject: Subject, isMoving: boolean): void {
  if (isOffered("calibrate")) connection.commandWith("calibrate", wordsOf(subject, isMoving));
}

export function cancelCalibration(): void {
  connection.command("calibrate-cancel");
}

export function saveCalibration(): void {
  connection.command("calibrate-save");
}
