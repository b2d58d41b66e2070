/** Tests begun from the screen. */
import { useTranslation } from "react-i18next";
import { problemText } from "@/shell/LoadProblem";
import { useOpenProgram } from "../state/context";
import { say } from "../state/ui";
import { useTesting, type Asked } from "./tests";

/** Say a refusal for a moment. */
export const tell = (t: (key: string) => string) => (problem: unknown) =>
  say(problemText(problem, t("shell.problem.screen")));

/** Begin tests, once the server has all that is drawn. */
export function useRun() {
  const { t } = useTranslation();
  const { program, shared } = useOpenProgram();
  const act = useTesting(program.id);
  const start = (asked: Asked) =>
    void shared
      .stored()
      .then(() => act.run(asked))
      .catch(tell(t));
  return { start, isPending: act.isPending };
}
