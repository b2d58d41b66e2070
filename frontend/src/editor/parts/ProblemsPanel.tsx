/** What is wrong, with the place, the line and, where one click helps, the remedy. */
import { Button } from "@mantine/core";
import { CircleCheck, OctagonAlert, TriangleAlert } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { api } from "@/api/client";
import type { LibraryFunction } from "@/api/types";
import { fixEdits, versionOf } from "../edits/fixes";
import { replaceFunction, type CutOut } from "../edits/library";
import type { Diagnostic, Fix } from "@/program/document/document";
import { makeId } from "../state/actions";
import { useOpenProgram } from "../state/context";
import { say, select, useUi } from "../state/ui";
import { doAndSay } from "../state/undoing";
import classes from "./drawer.module.css";

export function ProblemsPanel({ titled = false }: { titled?: boolean }) {
  const { diagnostics, compiled, t: editor } = useOpenProgram();
  const { t } = useTranslation();
  const unchecked = compiled === null;
  const errors = diagnostics.filter((each) => each.severity === "error");
  const warnings = diagnostics.filter((each) => each.severity === "warning");
  return (
    <div className={classes.problems} data-titled={titled || undefined}>
      {diagnostics.length === 0 ? (
        <p className={classes.nothing}>
          {unchecked ? null : <CircleCheck size={20} aria-hidden="true" />}
          {unchecked ? editor("problems_unchecked") : t("problems.none")}
        </p>
      ) : null}
      <Group title={t("problems.errors", { count: errors.length })} problems={errors} />
      <Group title={t("problems.warnings", { count: warnings.length })} problems={warnings} />
    </div>
  );
}

/** So many are listed before somebody asks for more. */
const LISTED = 50;

function Group({ title, problems }: { title: string; problems: readonly Diagnostic[] }) {
  const { t } = useTranslation();
  const [most, setMost] = useState(LISTED);
  if (problems.length === 0) return null;
  const rest = problems.length - most;
  return (
    <section className={classes.group} aria-label={title}>
      <h2 className={classes.heading}>{title}</h2>
      <ul className={classes.list}>
        {problems.slice(0, most).map((each, index) => (
          <Problem key={`${each.code} ${each.step} ${each.field} ${index}`} problem={each} />
        ))}
      </ul>
      {rest > 0 ? (
        <Button className={classes.rest} size="xs" variant="default" onClick={() => setMost(most + 4 * LISTED)}>
          {t("problems.rest", { count: rest })}
        </Button>
      ) : null}
    </section>
  );
}

function Problem({ problem }: { problem: Diagnostic }) {
  const { t: editor, document, compiled, canEdit } = useOpenProgram();
  const { t } = useTranslation();
  const selected = useUi((ui) => problem.step !== "" && ui.selected.includes(problem.step));
  const number = compiled?.numbers[problem.step];
  const kind = document.steps[problem.step]?.kind;
  return (
    <li className={classes.problem} data-severity={problem.severity} data-selected={selected || undefined}>
      {problem.severity === "error" ? (
        <OctagonAlert size={16} aria-label={editor("announce.error")} />
      ) : (
        <TriangleAlert size={16} aria-label={editor("announce.warning")} />
      )}
      <button type="button" className={classes.go} onClick={() => problem.step && select([problem.step])}>
        {problem.message}
      </button>
      <span className={classes.line}>{problem.line ?? ""}</span>
      <span className={classes.where}>
        {number && kind ? t("problems.where", { number, kind: editor(`kind.${kind}`) }) : null}
        {problem.when === "now" ? <em className={classes.now}>{t("problems.now")}</em> : null}
      </span>
      {problem.fix ? (
        <div className={classes.mend}>
          {canEdit ? <FixButton fix={problem.fix} /> : null}
          <CompareLink fix={problem.fix} />
        </div>
      ) : null}
    </li>
  );
}

/** To what a version of a library function changes, with the tests of this program on it. */
function CompareLink({ fix }: { fix: Fix }) {
  const { document, program, site } = useOpenProgram();
  const { t } = useTranslation();
  const wanted = versionOf(fix);
  const held = wanted ? document.functions[wanted.function]?.source?.version : undefined;
  if (!wanted || held === undefined) return null;
  const asked = new URLSearchParams({ old: String(held), new: String(wanted.version), program: program.id });
  return (
    <Link className={classes.compare} to={`/sites/${site.slug}/library/${wanted.library}/compare?${asked}`}>
      {t("problems.compare")}
    </Link>
  );
}

function FixButton({ fix }: { fix: Fix }) {
  const { document, apply } = useOpenProgram();
  const { t } = useTranslation();
  const bringVersion = useBringVersion();
  const mend = () => {
    const robotName = (number: number) => t("problems.robot", { number });
    if (versionOf(fix)) void bringVersion(fix);
    else apply(fixEdits(document, fix, { makeId, robotName }));
  };
  return (
    <Button size="xs" variant="default" onClick={mend}>
      {fix.label}
    </Button>
  );
}

/** What a version of a library function holds, or nothing where it cannot be had. */
async function fetchCut(library: string, version: number): Promise<CutOut | undefined> {
  const found = await api.get<LibraryFunction>(`/library/${library}/versions/${version}`);
  return found.definition ?? undefined;
}

/** Fetch the version of a library function that a remedy names, and put it in the place of the one here. */
function useBringVersion() {
  const { shared, apply } = useOpenProgram();
  const { t } = useTranslation();
  return async (fix: Fix) => {
    const wanted = versionOf(fix);
    if (!wanted) return;
    const { library, version, function: id } = wanted;
    const heldNow = () => shared.getDocument().functions[id]?.source?.version;
    const held = heldNow();
    try {
      const [cut, former] = await Promise.all([
        fetchCut(library, version),
        held === undefined ? undefined : fetchCut(library, held).catch(() => undefined),
      ]);
      if (!cut) return;
      const known = heldNow() === held ? former : undefined; // somebody may have brought another one meanwhile
      const edits = replaceFunction(shared.getDocument(), id, cut, { library, version }, makeId, known);
      doAndSay(
        { shared },
        () => apply(edits),
        () => t("problems.brought", { version }),
      );
    } catch (problem) {
      say(problem instanceof Error ? problem.message : String(problem));
    }
  };
}
