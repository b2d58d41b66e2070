/** What is wrong, with the place, the line and, where one click helps, the remedy. */
import { Button } from "@mantine/core";
import { CircleCheck, OctagonAlert, TriangleAlert } from "lucide-react";
import { fixEdits } from "../model/fixes";
import type { Diagnostic } from "../model/types";
import { useOpenProgram } from "../state/context";
import { select, useUi } from "../state/ui";
import classes from "./drawer.module.css";

export function ProblemsPanel({ titled = false }: { titled?: boolean }) {
  const { t, diagnostics } = useOpenProgram();
  const errors = diagnostics.filter((each) => each.severity === "error").length;
  return (
    <div className={classes.problems}>
      {titled ? (
        <h2 className={classes.heading}>
          {t("drawer.problems")}
          <span>{t("problems.count", { errors, warnings: diagnostics.length - errors })}</span>
        </h2>
      ) : null}
      {diagnostics.length === 0 ? (
        <p className={classes.nothing}>
          <CircleCheck size={20} aria-hidden="true" />
          {t("problems.none")}
        </p>
      ) : (
        <ul className={classes.list}>
          {diagnostics.map((each, index) => (
            <Problem key={`${each.code} ${each.step} ${each.field} ${index}`} problem={each} />
          ))}
        </ul>
      )}
    </div>
  );
}

function Problem({ problem }: { problem: Diagnostic }) {
  const { t, document, compiled, apply, canEdit } = useOpenProgram();
  const selected = useUi((ui) => problem.step !== "" && ui.selected.includes(problem.step));
  const number = compiled?.numbers[problem.step];
  const kind = document.steps[problem.step]?.kind;
  const { fix } = problem;
  return (
    <li className={classes.problem} data-severity={problem.severity} data-selected={selected || undefined}>
      {problem.severity === "error" ? (
        <OctagonAlert size={16} aria-label={t("announce.error")} />
      ) : (
        <TriangleAlert size={16} aria-label={t("announce.warning")} />
      )}
      <button type="button" className={classes.go} onClick={() => problem.step && select([problem.step])}>
        {problem.message}
      </button>
      <span className={classes.line}>{problem.line ?? ""}</span>
      {number && kind ? (
        <span className={classes.where}>{t("problems.where", { number, kind: t(`kind.${kind}`) })}</span>
      ) : null}
      {fix && canEdit ? (
        <Button className={classes.fix} size="xs" variant="default" onClick={() => apply(fixEdits(document, fix))}>
          {fix.label}
        </Button>
      ) : null}
    </li>
  );
}
