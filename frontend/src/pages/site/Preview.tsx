/** The chosen map image, before it is sent. */
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { readPgm, type Grey } from "./pgm";
import styles from "./newsite.module.css";

function paintGrey(canvas: HTMLCanvasElement, grey: Grey): void {
  const image = new ImageData(grey.width, grey.height);
  grey.pixels.forEach((shade, index) => image.data.set([shade, shade, shade, 255], index * 4));
  canvas.width = grey.width;
  canvas.height = grey.height;
  canvas.getContext("2d")?.putImageData(image, 0, 0);
}

async function paint(canvas: HTMLCanvasElement, file: File): Promise<boolean> {
  const grey = readPgm(new Uint8Array(await file.arrayBuffer()));
  if (grey) {
    paintGrey(canvas, grey);
    return true;
  }
  const bitmap = await createImageBitmap(file).catch(() => null);
  if (!bitmap) return false;
  canvas.width = bitmap.width;
  canvas.height = bitmap.height;
  canvas.getContext("2d")?.drawImage(bitmap, 0, 0);
  return true;
}

export function Preview({ file }: { file: File }) {
  const { t } = useTranslation();
  const canvas = useRef<HTMLCanvasElement>(null);
  const [readable, setReadable] = useState(true);
  useEffect(() => {
    let gone = false;
    if (canvas.current) void paint(canvas.current, file).then((done) => !gone && setReadable(done));
    return () => {
      gone = true;
    };
  }, [file]);
  return (
    <figure className={styles.preview}>
      <canvas ref={canvas} hidden={!readable} role="img" aria-label={t("pages.newSite.preview")} />
      {readable ? null : <p>{t("pages.newSite.noPreview")}</p>}
      <figcaption>{file.name}</figcaption>
    </figure>
  );
}
