/** What the server refused about a place, said where everybody sees it. */
import { notifications } from "@mantine/notifications";
import type { TFunction } from "i18next";
import { problemText } from "@/shell/LoadProblem";

export function tellRefusal(error: Error, t: TFunction): void {
  notifications.show({ color: "red", message: problemText(error, t("shell.problem.screen")), autoClose: 8000 });
}
