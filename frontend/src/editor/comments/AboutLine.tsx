/** What a thread is about: leads to its step on the map, or to its moment of a run. */
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import type { Thread } from "@/api/types";
import classes from "@/shell/comments/comments.module.css";
import { momentOf, momentPath } from "@/shell/comments/moments";
import { showSteps } from "../commands/view";
import { useOpenProgram } from "../state/context";
import { select } from "../state/ui";
import { standsNow, stepOf } from "./about";

export function AboutLine({ thread, about }: { thread: Thread; about: string }) {
  const { t } = useTranslation();
  const open = useOpenProgram();
  const step = stepOf(open, thread);
  if (step !== null)
    return (
      <button
        type="button"
        className={classes.about}
        onClick={() => {
          select([step]);
          showSteps(open, [step]);
        }}
      >
        {about}
      </button>
    );
  const moment = momentOf(thread);
  if (moment)
    return (
      <Link className={classes.about} to={momentPath(moment, thread.id)}>
        {about}
      </Link>
    );
  return (
    <span className={classes.about}>
      {about}
      {standsNow(open, thread) ? null : <em> {t("comments.deleted")}</em>}
    </span>
  );
}
