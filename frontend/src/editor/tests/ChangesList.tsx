/** Which changes of the program no test notices: what could be taken out of it, and all tests would still pass. */
import { Button } from "@mantine/core";
import { CircleCheck, Plus, ShieldQuestion, TriangleAlert } from "lucide-react";
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { mayOperate } from "@/api/roles";
import type { ProgramTests, UnnoticedChange } from "@/api/types";
import { showSteps } from "../commands/view";
import { useOpenProgram } from "../state/context";
import { select } from "../state/ui";
import classes from "./tests.module.css";
import { keepDraft, NEW, openTest, useTesting } from "./tests";
import { tell, useRun } from "./useRun";

export function ChangesList({ tests }: { tests: ProgramTests }) {
  const { t } = useTranslation();
  const { site } = useOpenProgram();
  const run = useRun();
  const { changes } = tests;
  if (tests.tests.length === 0) return null;
  return (
    <section className={classes.coverage} aria-label={t("tests.changes.title")}>
      <div className={classes.coverageHead}>
        <h2>{t("tests.changes.title")}</h2>
        {mayOperate(site.role) ? (
          <Button
            size="compact-xs"
            variant="default"
            leftSection={<ShieldQuestion size={13} aria-hidden="true" />}
            loading={run.isPending}
            disabled={tests.under_way.length > 0}
            onClick={() => run.start({ changes: true })}
          >
            {t("tests.changes.try")}
          </Button>
        ) : null}
      </div>
      {changes ? <Found changes={changes} /> : <p className={classes.stale}>{t("tests.changes.intro")}</p>}
    </section>
  );
}

function Found({ changes }: { changes: NonNullable<ProgramTests["changes"]> }) {
  const { t } = useTranslation();
  const { noticed, tried, there_are: all } = changes;
  const open = changes.unnoticed.filter((each) => each.meant_at === null);
  const meant = changes.unnoticed.filter((each) => each.meant_at !== null);
  if (changes.why === "failing") return <p>{t("tests.changes.failing")}</p>;
  if (all === 0) return <p>{t("tests.changes.no_changes")}</p>;
  const rest = changes.out_of_time
    ? t("tests.changes.out_of_time", { tried, all })
    : t("tests.changes.some", { tried, all });
  return (
    <>
      <p>
        {t("tests.changes.figures", { noticed, tried })}
        {tried < all ? `. ${rest}` : ""}
      </p>
      {changes.stale ? <p className={classes.stale}>{t("tests.changes.stale")}</p> : null}
      {open.length === 0 && tried > 0 ? (
        <p className={classes.all}>
          <CircleCheck size={16} aria-hidden="true" />
          {t(meant.length > 0 ? "tests.changes.none_but_meant" : "tests.changes.none")}
        </p>
      ) : null}
      <ul className={classes.missed}>
        {open.map((each) => (
          <Unnoticed key={keyOf(each)} change={each} />
        ))}
      </ul>
      {meant.length > 0 ? (
        <details className={classes.meant}>
          <summary>{t("tests.changes.meant", { count: meant.length })}</summary>
          <ul className={classes.missed}>
            {meant.map((each) => (
              <Unnoticed key={keyOf(each)} change={each} />
            ))}
          </ul>
        </details>
      ) : null}
    </>
  );
}

const keyOf = ({ step, code, name }: UnnoticedChange) => `${step} ${code} ${name}`;

function Unnoticed({ change }: { change: UnnoticedChange }) {
  const { t } = useTranslation();
  const open = useOpenProgram();
  const tests = useTesting(open.program.id);
  const { step } = change;
  const isMeant = change.meant_at !== null;
  const what = t(`tests.changes.what.${change.code}`, { name: change.name });
  const kind = open.document.steps[step]?.kind;
  const number = open.compiled?.numbers[step] ?? "";
  const where = kind ? t("tests.where", { number, kind: open.t(`kind.${kind}`) }) : t("tests.the_program");
  const go = () => {
    select([step]);
    showSteps(open, [step]);
  };
  const write = () => {
    keepDraft(NEW, { id: null, text: textFor(where.trim(), number), tag: "" });
    openTest(NEW);
  };
  return (
    <li className={classes.unnoticed}>
      <button type="button" disabled={!kind} onClick={go}>
        {isMeant ? <CircleCheck size={14} aria-hidden="true" /> : <TriangleAlert size={14} aria-hidden="true" />}
        <span>
          <strong>{where.trim()}</strong> {what}
          {change.reached ? null : <small> {t("tests.changes.not_reached")}</small>}
          {isMeant ? (
            <small> {t("tests.changes.meant_by", { name: change.meant_by || t("tests.changes.somebody") })}</small>
          ) : null}
        </span>
      </button>
      {open.canEdit ? (
        <div className={classes.answers}>
          {isMeant ? null : (
            <Answer
              icon={<Plus size={12} aria-hidden="true" />}
              text={t("tests.changes.write")}
              of={where.trim()}
              act={write}
            />
          )}
          {change.mark === "" ? null : (
            <Answer
              text={t(isMeant ? "tests.changes.not_meant" : "tests.changes.is_meant")}
              of={`${where.trim()} ${what}`}
              isBusy={tests.isPending}
              act={() => void tests.say(change, !isMeant).catch(tell(t))}
            />
          )}
        </div>
      ) : null}
    </li>
  );
}

/** What one may do about a change that no test notices. */
function Answer({
  icon,
  text,
  of,
  isBusy = false,
  act,
}: {
  icon?: ReactNode;
  text: string;
  of: string;
  isBusy?: boolean;
  act: () => void;
}) {
  return (
    <Button
      size="compact-xs"
      variant="subtle"
      className={classes.write}
      leftSection={icon}
      aria-label={`${text}: ${of}`}
      disabled={isBusy}
      onClick={act}
    >
      {text}
    </Button>
  );
}

/** A test that begins where somebody who wants to notice the change would begin: at the step. */
function textFor(where: string, number: string): string {
  const then = number ? `  - step: {step: ${JSON.stringify(number)}, times: 1}\n` : "";
  return `name: ${JSON.stringify(where)}\nthen:\n  - ends: well\n${then}`;
}
