/** The list of a program's tests: how each came out last, and whether that still says something. */
import { Ban, CircleCheck, CircleDashed, CircleX, Clock } from "lucide-react";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import type { ProgramTest, ProgramTests, TestResult } from "@/api/types";
import { formatSpan } from "@/i18n/format";
import { useOpenProgram } from "../state/context";
import { scaleOf, type Scale } from "./odds";
import { OddsCells } from "./OddsCells";
import { expectedWords, seenWords, type Expectation } from "@/program/words/testSentences";
import classes from "./tests.module.css";
import { NEW, openTest, useTestsUi } from "./tests";

const SIGNS = { passed: CircleCheck, failed: CircleX, unusable: Ban, stopped: Clock, none: CircleDashed } as const;

export function TestList({ tests }: { tests: ProgramTests }) {
  const { t } = useTranslation();
  const { canEdit } = useOpenProgram();
  const fresh = useTestsUi((ui) => ui.drafts[NEW] !== undefined);
  const scale = useMemo(() => scaleOf(tests.tests), [tests.tests]);
  if (tests.tests.length === 0 && !fresh)
    return <p className={classes.none}>{t(canEdit ? "tests.none" : "tests.none_look")}</p>;
  return (
    <ul className={classes.list} aria-label={t("tests.list")} data-odds={tests.tests.some(hasOdds) || undefined}>
      {fresh ? <Fresh /> : null}
      {tests.tests.map((test) => (
        <Row key={test.id} test={test} scale={scale} />
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

const hasOdds = ({ result }: ProgramTest) => Boolean(result?.odds);

/** What of the site, or what else, has changed since a result; empty: nothing. */
export function staleWords({ stale, site_change: change }: TestResult, t: Words): string {
  if (!stale) return "";
  if (stale !== "site" || !change) return t(`tests.stale.${stale}`);
  return t(`tests.stale_site.${change.what}`, { count: change.devices.length, devices: change.devices.join(", ") });
}

type Words = (key: string, values?: Record<string, unknown>) => string;

function Row({ test, scale }: { test: ProgramTest; scale: Scale | null }) {
  const { t } = useTranslation();
  const opened = useTestsUi((ui) => ui.opened === test.id);
  const unsaved = useTestsUi((ui) => ui.drafts[test.id] !== undefined);
  const { result } = test;
  const stale = result ? staleWords(result, t) : "";
  const broken = result?.expectations.find(({ ok }) => !ok);
  const notes = [unsaved ? t("tests.unsaved") : "", stale].filter(Boolean);
  return (
    <li className={classes.row} data-opened={opened || undefined} data-stale={stale ? true : undefined}>
      <Status status={result?.status ?? "none"} />
      <button type="button" className={classes.open} aria-pressed={opened} onClick={() => openTest(test.id)}>
        <span>{test.name}</span>
        {notes.length > 0 ? <small>{notes.join(", ")}</small> : null}
        {broken && notes.length === 0 ? <Broken expectation={broken} /> : null}
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
      <OddsCells odds={result?.odds ?? null} scale={scale} stale={stale !== ""} />
    </li>
  );
}

function Broken({ expectation }: { expectation: Expectation }) {
  const { t } = useTranslation();
  const [expected, saw] = [expectedWords(expectation, t), seenWords(expectation, t)];
  return (
    <small>
      <span lang={expected.lang}>{expected.text}</span>: <span lang={saw.lang}>{saw.text}</span>
    </small>
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
