/** What the server refused, said in the corner where everybody sees it. */
import { notifications } from "@mantine/notifications";
import type { TFunction } from "i18next";
import { useEffect, useRef } from "react";
import { useTranslation } from "react-i18next";
import { problemText } from "./LoadProblem";

export function tellRefusal(error: Error, t: TFunction): void {
  notifications.show({ color: "red", message: problemText(error, t("shell.problem.screen")), autoClose: 8000 });
}

/** Tells a refusal that the caller shows itself, such as a dialog, where the caller is gone before it comes. */
export function useTellUnseen(): (error: Error) => void {
  const { t } = useTranslation();
  const isShown = useRef(true);
  useEffect(() => {
    isShown.current = true;
    return () => {
      isShown.current = false;
    };
  }, []);
  return (error) => {
    if (!isShown.current) tellRefusal(error, t);
  };
}
