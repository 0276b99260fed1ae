// SPDX-License-Identifier: BSD-3-Clause
// The table of a study as the program would send it, for work on the page without it.

const recordings = 40;
const judgement = "Worse in 19 of 40 and better in 20 of 40; kestrel study report judges whether that is chance";
const variants = ["usual", "strict min_quality=0.9", "small rings"];

/** A study that counts up to a recording's frames when one is opened. */
export class MockStudy {
  constructor(send, open) {
    this.send = send;
    this.open = open;
    this.compare(0, 1);
    this.tell("none");
  }

  receive(message) {
    if (message.command === "compare") this.compare(...message.settings.map(Number));
    if (message.command === "open") this.start(this.rows[message.value]);
    if (message.command === "cancel" && this.timer) this.end("cancelled");
  }

  compare(before, after) {
    this.before = before;
    this.after = after;
    this.rows = Array.from({ length: recordings }, (_, i) => rowOf(i, before, after));
    const place = ({ change, after: { failure } }) => (failure !== "" ? -2 : (change ?? 2));
    this.rows.sort((a, b) => place(a) - place(b));
    this.send({ kind: "study", variants, before, after, rows: this.rows, total: 1240, judgement, remark: "", error: "" });
  }

  start(row) {
    clearInterval(this.timer);
    this.row = row;
    this.done = 0;
    this.timer = setInterval(() => {
      this.done += 40;
      if (this.row.after.failure !== "") return this.end("failed", "the recording is not on this computer: sftp://nas/dusk");
      if (this.done < 600) return this.tell("running");
      this.end("open");
      return this.open(variants[this.after]);
    }, 100);
    this.tell("running");
  }

  end(state, error = "") {
    clearInterval(this.timer);
    this.timer = null;
    this.tell(state, error);
  }

  tell(state, error = "") {
    const [before, after] = [variants[this.before], variants[this.after]];
    const recording = this.row?.recording ?? "";
    this.send({ kind: "study-replay", state, recording, before, after, done: this.done ?? 0, frames: 600, error });
  }
}

function rowOf(i, before, after) {
  const fails = i === 7 && after !== before;
  const outcomes = [outcomeOf(i, before, false), outcomeOf(i, after, fails)];
  const change = fails ? null : outcomes[1].found - outcomes[0].found;
  return { recording: `flights/2026-03-${String(i + 1).padStart(2, "0")}`, piece: 0, before: outcomes[0], after: outcomes[1], change };
}

function outcomeOf(i, variant, fails) {
  if (fails) return { done: true, failure: "killed: more than 4000 MB of memory", found: null, false: null, error_m: null, estimated: false };
  const found = 0.93 - 0.02 * (i % 7) - (variant === 1 ? 0.12 * Math.sin(i) : 0);
  return { done: true, failure: "", found, false: (i * (variant + 1)) % 5, error_m: 0.03 + 0.002 * (i % 9), estimated: i % 6 === 0 };
}
