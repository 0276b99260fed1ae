// SPDX-License-Identifier: BSD-3-Clause
import { render } from "preact";
import { App } from "./components/app";
import { startAlarm } from "./alarm";
import { connection } from "./connection";
import { handleKey } from "./keys";
import { firstPage } from "./pages";
import { store } from "./store";
import "./style.css";
import { applyTheme, savedTheme } from "./theme";

const theme = savedTheme();
applyTheme(theme);
store.set({ theme, page: firstPage() });
document.addEventListener("keydown", handleKey);
render(<App />, document.getElementById("app")!);
connection.open();
startAlarm();
