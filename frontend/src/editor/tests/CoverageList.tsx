/** Which ways through the program no test takes, in words; a press goes to the step. */
import { Button, Switch } from "@mantine/core";
import { CircleCheck } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { ProgramTests } from "@/api/types";
import { showSteps } from "../commands/view";
import { useOpenProgram } from "../state/context";
import { select } from "../state/ui";
import { figuresOf, missedOf, wordsOf, type Missed } from "./coverage";
import classes from "./tests.module.css";
import { useTestsUi } from "./tests";

const LISTED = 50;

export function CoverageList({ tests: { coverage } }: { tests: ProgramTests }) {
  const { t } = useTranslation();
  const [most, setMost] = useState(LISTED);
  const marks = useTestsUi((ui) => ui.marks);
  if (!coverage) return <p className={classes.none}>{t("tests.coverage_none")}</p>;
  const { steps, ways } = figuresOf(coverage.constructs);
  const missed = missedOf(coverage.constructs);
  return (
    <section className={classes.coverage} aria-label={t("tests.coverage")}>
      <div className={classes.coverageHead}>
        <h2>{t("tests.coverage")}</h2>
        <Switch
          size="xs"
          label={t("tests.on_map")}
          checked={marks}
          onChange={(event) => useTestsUi.setState({ marks: event.currentTarget.checked })}
        />
      </div>
      <p>
        {t("tests.steps_taken", { ...steps })}
        {ways.all > 0 ? `, ${t("tests.ways_taken", { ...ways })}` : null}
      </p>
      <progress
        aria-label={t("tests.coverage")}
        max={Math.max(1, steps.all + ways.all)}
        value={steps.taken + ways.taken}
      />
      {coverage.stale ? <p className={classes.stale}>{t("tests.coverage_stale")}</p> : null}
      {missed.length === 0 ? (
        <p className={classes.all}>
          <CircleCheck size={16} aria-hidden="true" />
          {t("tests.all_taken")}
        </p>
      ) : null}
      <ul className={classes.missed}>
        {missed.slice(0, most).map((each) => (
          <MissedWay key={`${each.step} ${each.way}`} missed={each} />
        ))}
      </ul>
      {missed.length > most ? (
        <Button size="xs" variant="default" onClick={() => setMost(most + 4 * LISTED)}>
          {t("problems.rest", { count: missed.length - most })}
        </Button>
      ) : null}
    </section>
  );
}

function MissedWay({ missed: { step, way } }: { missed: Missed }) {
  const { t } = useTranslation();
  const open = useOpenProgram();
  const kind = open.document.steps[step]?.kind;
  const number = open.compiled?.numbers[step] ?? "";
  const where = kind ? t("tests.where", { number, kind: open.t(`kind.${kind}`) }) : t("tests.the_program");
  const go = () => {
    select([step]);
    showSteps(open, [step]);
  };
  return (
    <li>
      <button type="button" disabled={!kind} onClick={go}>
        <strong>{where.trim()}</strong> {wordsOf(way, t)}
      </button>
    </li>
  );
}
