/** The 3D view as a film: its canvas is recorded by the browser while the recording plays. */
const PICTURES_PER_S = 30;
const FORMS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];

/** The form in which this browser can record; null: it cannot. */
export function filmForm(): string | null {
  if (typeof MediaRecorder === "undefined") return null;
  return FORMS.find((form) => MediaRecorder.isTypeSupported(form)) ?? null;
}

export interface Film {
  /** End it; the film that was recorded until now. */
  end: () => Promise<Blob>;
  /** End it and keep nothing. */
  drop: () => void;
}

/** Begin to record what a canvas shows; null where that cannot be. */
export function beginFilm(canvas: HTMLCanvasElement): Film | null {
  const form = filmForm();
  if (form === null) return null;
  const stream = canvas.captureStream(PICTURES_PER_S);
  const recorder = new MediaRecorder(stream, { mimeType: form, videoBitsPerSecond: 8_000_000 });
  const parts: Blob[] = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  recorder.start(1000);
  const over = new Promise<Blob>((resolve) => {
    recorder.onstop = () => {
      stream.getTracks().forEach((track) => track.stop());
      resolve(new Blob(parts, { type: "video/webm" }));
    };
  });
  const stop = () => {
    if (recorder.state !== "inactive") recorder.stop();
  };
  return {
    end: () => {
      stop();
      return over;
    },
    drop: stop,
  };
}

/** Hand a file to the person. */
export function saveFile(content: Blob, name: string): void {
  const address = URL.createObjectURL(content);
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
