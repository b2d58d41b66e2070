/** The list of a program's tests: how each came out last, and whether that still says something. */
import { Ban, CircleCheck, CircleDashed, CircleX, Clock } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { ProgramTest, ProgramTests } from "@/api/types";
import { formatSpan } from "@/i18n/format";
import { useOpenProgram } from "../state/context";
import classes from "./tests.module.css";
import { NEW, openTest, useTestsUi } from "./tests";

const SIGNS = { passed: CircleCheck, failed: CircleX, unusable: Ban, stopped: Clock, none: CircleDashed } as const;

export function TestList({ tests }: { tests: ProgramTests }) {
  const { t } = useTranslation();
  const { canEdit } = useOpenProgram();
  const fresh = useTestsUi((ui) => ui.drafts[NEW] !== undefined);
  if (tests.tests.length === 0 && !fresh)
    return <p className={classes.none}>{t(canEdit ? "tests.none" : "tests.none_look")}</p>;
  return (
    <ul className={classes.list} aria-label={t("tests.list")}>
      {fresh ? <Fresh /> : null}
      {tests.tests.map((test) => (
        <Row key={test.id} test={test} />
      ))}
    </ul>
  );
}

/** The test that is written and not there yet. */
function Fresh() {
  const { t } = useTranslation();
  const opened = useTestsUi((ui) => ui.opened === NEW);
  return (
    <li className={classes.row} data-opened={opened || undefined}>
      <Status status="none" />
      <button type="button" className={classes.open} aria-pressed={opened} onClick={() => openTest(NEW)}>
        <span>{t("tests.new")}</span>
        <small>{t("tests.unsaved")}</small>
      </button>
    </li>
  );
}

function Row({ test }: { test: ProgramTest }) {
  const { t } = useTranslation();
  const opened = useTestsUi((ui) => ui.opened === test.id);
  const unsaved = useTestsUi((ui) => ui.drafts[test.id] !== undefined);
  const { result } = test;
  const stale = result?.stale ? t(`tests.stale.${result.stale}`) : "";
  const broken = result?.expectations.find(({ ok }) => !ok);
  const notes = [unsaved ? t("tests.unsaved") : "", stale].filter(Boolean);
  return (
    <li className={classes.row} data-opened={opened || undefined} data-stale={stale ? true : undefined}>
      <Status status={result?.status ?? "none"} />
      <button type="button" className={classes.open} aria-pressed={opened} onClick={() => openTest(test.id)}>
        <span>{test.name}</span>
        {notes.length > 0 ? <small>{notes.join(", ")}</small> : null}
        {broken && notes.length === 0 ? <small lang="en">{`${broken.expected}: ${broken.saw}`}</small> : null}
      </button>
      <span className={classes.took}>
        {result && result.duration_s > 0 ? (
          <>
            <span className="visually-hidden">{t("tests.took")}</span>
            {formatSpan(result.duration_s)}
          </>
        ) : null}
      </span>
      <span className={classes.seed}>{result ? t("tests.seed", { seed: result.seed }) : ""}</span>
    </li>
  );
}

export function Status({ status }: { status: keyof typeof SIGNS }) {
  const { t } = useTranslation();
  const Sign = SIGNS[status];
  return (
    <span className={classes.status} data-status={status}>
      <Sign size={15} aria-hidden="true" />
      {t(`tests.status.${status}`)}
    </span>
  );
}
