// SPDX-License-Identifier: BSD-3-Clause
import { useEffect, useRef, useState } from "preact/hooks";
import { keepFrame } from "../color_actions";
import type { Colors } from "../color_protocol";
import { connection, type Picture } from "../connection";

/** What the camera sees now, of a flight: frames of it are kept to be marked. */
export function ColorCamera({ colors }: { colors: Colors }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [hasImage, setHasImage] = useState(false);
  useEffect(() => {
    connection.onPicture = (picture) => {
      requestAnimationFrame(() => {
        if (canvas.current) draw(canvas.current, picture);
        picture.bitmap.close();
        setHasImage(true);
        connection.drawn(picture.header);
      });
    };
    connection.wantImages({ view: "", isHeld: false });
    return () => {
      connection.wantImages(null);
      connection.onPicture = null;
    };
  }, []);
  return (
    <section class="camera" aria-label="Camera">
      <h2>Camera</h2>
      <div class="screen">
        <canvas ref={canvas} role="img" aria-label={hasImage ? "camera image" : "no image yet"} />
        {!hasImage && <p class="empty">No image yet</p>}
      </div>
      <div class="replay-buttons">
        <button onClick={keepFrame}>Keep frame</button>
        <span class="replay-time">
          {colors.frames} of {colors.most_kept} kept
        </span>
      </div>
    </section>
  );
}

function draw(canvas: HTMLCanvasElement, { header, bitmap }: Picture): void {
  canvas.width = header.width;
  canvas.height = header.height;
  canvas.getContext("2d")?.drawImage(bitmap, 0, 0);
}
