/** What the server refused, said in the corner where everybody sees it. */
import { notifications } from "@mantine/notifications";
import type { TFunction } from "i18next";
import { problemText } from "./LoadProblem";

export function tellRefusal(error: Error, t: TFunction): void {
  notifications.show({ color: "red", message: problemText(error, t("shell.problem.screen")), autoClose: 8000 });
}
