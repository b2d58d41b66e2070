/** What something waits for, in the language of the screen. */
import i18next from "i18next";

interface Reason {
  code: string;
  args: Readonly<Record<string, string | number | boolean>>;
}

/** `run 12` is what the server calls a run. */
function runWords(run: string): string {
  const number = /^run (\d+)$/.exec(run)?.[1];
  return number ? i18next.t("run.title", { number }) : run;
}

/** The sentence for a reason; null where the screens do not know it, so that the server's own is shown. */
export function waitWords(reason: Reason | null | undefined, nameOf: (device: string) => string): string | null {
  if (!reason) return null;
  const { device, robot, run, others } = reason.args;
  const code = reason.code === "machine_busy" && run ? "machine_busy_for" : reason.code;
  if (!i18next.exists(`run.waits.${code}`)) return null;
  return i18next.t(`run.waits.${code}`, {
    ...reason.args,
    device: nameOf(String(device ?? "")),
    robot: nameOf(String(robot ?? "")),
    run: runWords(String(run ?? "")),
    others: String(others ?? "")
      .split(",")
      .map(nameOf)
      .join(i18next.t("run.waits.and")),
  });
}
