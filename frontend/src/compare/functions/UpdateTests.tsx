/** The tests of a program on a version of a function that it may take in; nothing is changed by them. */
import { Button } from "@mantine/core";
import { useMutation, useQuery } from "@tanstack/react-query";
import { FlaskConical } from "lucide-react";
import { useTranslation } from "react-i18next";
import { api, ApiProblem } from "@/api/client";
import { useOnce } from "@/api/once";
import { keys } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { Program, Role, TestRun, WholeTestRun } from "@/api/types";
import { useFreshRehearsal } from "@/live/rehearsal";
import { StatusGlyph } from "@/design/StatusGlyph";
import { expectedWords, seenWords } from "@/program/words/testSentences";
import { problemText } from "@/shell/LoadProblem";
import compare from "../compare.module.css";
import styles from "./functions.module.css";

interface UpdateTestsProps {
  program: Program;
  role: Role;
  update: { library: string; version: number };
}

const UNDER_WAY = ["queued", "running"];

function useTestRun(program: string, run: string | undefined) {
  return useQuery({
    queryKey: [...keys.tests(program), "run", run],
    queryFn: () => api.get<WholeTestRun>(`/programs/${program}/test-runs/${run}`),
    enabled: run !== undefined,
    staleTime: 0,
  }).data;
}

export function UpdateTests({ program, role, update }: UpdateTestsProps) {
  const { t } = useTranslation();
  const begin = useOnce();
  const start = useMutation({ mutationFn: () => begin<TestRun>(`/programs/${program.id}/test-runs`, { update }) });
  const run = useTestRun(program.id, start.data?.id);
  if (!mayOperate(role)) return null;
  const isUnderWay = start.isPending || (start.data !== undefined && (!run || UNDER_WAY.includes(run.status)));
  return (
    <section className={styles.tests} aria-label={t("compare.function.tests", { program: program.name })}>
      <div className={styles.line}>
        <b>{t("compare.function.tests", { program: program.name })}</b>
        <Button
          size="xs"
          variant="default"
          leftSection={<FlaskConical size={14} aria-hidden="true" />}
          disabled={isUnderWay}
          onClick={() => start.mutate()}
        >
          {t(start.data ? "compare.function.again" : "compare.function.start", { number: update.version })}
        </Button>
        {isUnderWay ? <Progress rehearsal={start.data?.rehearsal ?? undefined} /> : null}
        <div role="status">{run && !isUnderWay ? <Outcome run={run} /> : null}</div>
      </div>
      {start.error ? <p role="alert">{refusalWords(start.error, t)}</p> : null}
      {run && !isUnderWay ? <Failing run={run} /> : null}
    </section>
  );
}

type Words = (key: string, values?: Record<string, unknown>) => string;

/** A program without tests has nothing to try; the other refusals say themselves how to mend it. */
function refusalWords(problem: Error, t: Words): string {
  const isNone = problem instanceof ApiProblem && problem.code === "not_found";
  return isNone ? t("compare.function.none") : problemText(problem, t("shell.problem.screen"));
}

function Progress({ rehearsal }: { rehearsal: string | undefined }) {
  const { t } = useTranslation();
  const progress = useFreshRehearsal(rehearsal).data?.progress ?? 0;
  return (
    <label className={compare.progress}>
      <small>{t("compare.function.under_way")}</small>
      <progress value={progress} max={1} />
    </label>
  );
}

function Outcome({ run }: { run: WholeTestRun }) {
  const { t } = useTranslation();
  if (run.status !== "done") return <span>{t(`compare.function.${run.status}`, { reason: run.reason })}</span>;
  return (
    <span className={styles.outcome}>
      <StatusGlyph status={run.passed === run.total ? "done" : "error"} size={15} />
      {t("tests.pass", { count: run.total, passed: run.passed })}
    </span>
  );
}

/** What the tests that do not pass expected and saw. */
function Failing({ run }: { run: WholeTestRun }) {
  const { t } = useTranslation();
  const failing = run.results.filter(({ status }) => status !== "passed");
  if (failing.length === 0) return null;
  return (
    <ul className={styles.failing}>
      {failing.map((result) => (
        <li key={result.id}>
          <b>{result.name}</b> {t(`tests.status.${result.status}`)}
          {result.why ? <span lang="en">: {result.why}</span> : null}
          {result.expectations
            .filter(({ ok }) => !ok)
            .map((each, at) => {
              const [expected, seen] = [expectedWords(each, t), seenWords(each, t)];
              return (
                <span key={at} className={styles.seen}>
                  <span lang={expected.lang}>{t("tests.expected", { what: expected.text })}</span>
                  {" · "}
                  <span lang={seen.lang}>{t("tests.saw", { what: seen.text })}</span>
                </span>
              );
            })}
        </li>
      ))}
    </ul>
  );
}
