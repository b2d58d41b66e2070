/** Why something ended or was not done, in the language of the screen; a device's own words stay, in quotes. */
import i18next from "i18next";

interface Cause {
  readonly code: string;
  readonly args: Readonly<Record<string, string>>;
}

/** The server's own words where the screens do not know the cause. */
export function reasonWords(cause: Cause | null | undefined, text: string): string {
  const key = `reason.because.${cause?.code ?? ""}`;
  return cause && i18next.exists(key) ? i18next.t(key, { ...cause.args }) : text;
}
