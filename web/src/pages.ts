// SPDX-License-Identifier: BSD-3-Clause
// The pages of a recording or a study; a flight has no calibration.
import { isOffered } from "./actions";
import { store, type Page } from "./store";

export function pageName(page: Page): string {
  if (page === "watch") return store.state.hello?.live ? "Flight" : "Replay";
  if (page === "study") return "Table";
  return page === "colors" ? "Colours" : "Calibration";
}

/** Those that this server has something for. */
export function offeredPages(): Page[] {
  if (isOffered("open")) return store.state.studyReplay?.state === "open" ? ["study", "watch"] : ["study"];
  const pages: Page[] = ["watch"];
  if (store.state.hello?.colors) pages.push("colors");
  if (isOffered("calibrate")) pages.push("calibration");
  return pages;
}

/** The page that the address asks for. */
export function firstPage(): Page {
  const asked = location.hash.slice(1);
  return asked === "colors" || asked === "calibration" ? asked : "watch";
}

export function showPage(page: Page): void {
  store.set({ page });
  history.replaceState(null, "", page === "watch" ? location.pathname : `#${page}`);
}

/** To a page, or from it back to the recording. */
export function togglePage(page: Page): void {
  showPage(store.state.page === page ? "watch" : page);
}
