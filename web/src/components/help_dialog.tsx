// SPDX-License-Identifier: BSD-3-Clause
import { useEffect, useRef } from "preact/hooks";
import { toggleHelp } from "../actions";
import { keys } from "../keys";
import { useStore } from "../use_store";

const keyName = (key: string) => (key === " " ? "space" : key);

export function HelpDialog() {
  const isShown = useStore((state) => state.isHelpShown);
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    if (isShown) dialog.current?.showModal();
    else dialog.current?.close();
  }, [isShown]);
  return (
    <dialog ref={dialog} aria-label="Keys" onCancel={(event) => event.preventDefault()}>
      <h2>Keys</h2>
      <table>
        <tbody>
          {keys().map((key) => (
            <tr key={key.keys[0]}>
              <th scope="row">
                <kbd>{key.keys.map(keyName).join(" or ")}</kbd>
              </th>
              <td>{key.meaning}</td>
            </tr>
          ))}
        </tbody>
      </table>
      <button onClick={toggleHelp}>Close</button>
    </dialog>
  );
}
