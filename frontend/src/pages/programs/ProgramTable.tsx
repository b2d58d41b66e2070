/** Programs as rows: what they use, who edited them, whether they are sound, when they last ran. */
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useSite } from "@/api/queries";
import { NEWEST_RUNS } from "@/api/runs";
import type { Program, RunSummary } from "@/api/types";
import { ArmSwitch } from "@/shell/ArmSwitch";
import { Avatar } from "@/design/Avatar";
import { StatusBadge } from "@/design/StatusBadge";
import { formatAgo } from "@/i18n/format";
import { isOpen } from "@/live/messages";
import { StepIcons } from "@/program/StepIcons";
import styles from "../pages.module.css";
import { nameOf } from "../people";
import { joinRuns, lastRuns, statusOfRun } from "../runs/runStatus";
import { ProgramActions } from "./ProgramActions";
import { useNow } from "@/design/useNow";

export function Soundness({ program }: { program: Program }) {
  const { t } = useTranslation();
  if (program.kinds.length === 0) return <StatusBadge status="idle">{t("pages.programs.empty")}</StatusBadge>;
  if (program.errors > 0)
    return <StatusBadge status="error">{t("pages.programs.errors", { count: program.errors })}</StatusBadge>;
  if (program.warnings > 0)
    return <StatusBadge status="warning">{t("pages.programs.warnings", { count: program.warnings })}</StatusBadge>;
  return <StatusBadge status="done">{t("pages.programs.checked")}</StatusBadge>;
}

function LastRun({ run, never, now }: Pick<RowProps, "run" | "never" | "now">) {
  const { t } = useTranslation();
  if (!run) return <>{never}</>;
  const when = run.started_at ? formatAgo(run.ended_at ?? run.started_at, now) : "";
  return (
    <Link to={`/runs/${run.id}`} className={styles.link}>
      <StatusBadge status={statusOfRun(run)}>
        {isOpen(run) ? t("pages.runs.numberRunning", { number: run.number }) : when}
      </StatusBadge>
    </Link>
  );
}

interface RowProps {
  program: Program;
  run: RunSummary | undefined;
  /** What is said where no run is known. */
  never: string;
  now: number;
  editable: boolean;
}

function Row({ program, run, never, now, editable }: RowProps) {
  const { t } = useTranslation();
  const editor = nameOf(program.edited_by);
  const role = useSite(program.site).data?.role;
  return (
    <tr>
      <td className={styles.name}>
        <Link to={`/programs/${program.id}`} className={styles.strong} title={program.name}>
          {program.name}
        </Link>
        <ArmSwitch site={program.site} program={program} role={role} />
      </td>
      <td className={styles.optional}>
        {program.kinds.length > 0 ? (
          <StepIcons kinds={program.kinds} />
        ) : (
          <span className={styles.none}>{t("pages.programs.noSteps")}</span>
        )}
      </td>
      <td>
        <span className={styles.person}>
          {editor ? <Avatar name={editor} size={22} title={editor} /> : null}
          {formatAgo(program.edited_at, now)}
        </span>
      </td>
      <td>
        <Soundness program={program} />
      </td>
      <td>
        <LastRun run={run} never={never} now={now} />
      </td>
      {editable ? (
        <td className={styles.more}>
          <ProgramActions program={program} />
        </td>
      ) : null}
    </tr>
  );
}

interface ProgramTableProps {
  programs: readonly Program[];
  /** The newest runs of the site; undefined until they are known. */
  runs: readonly RunSummary[] | undefined;
  /** Those that are not over, however old they are; undefined until they are known. */
  open: readonly RunSummary[] | undefined;
  /** Whether the reader may rename and delete. */
  editable: boolean;
}

/** What is true of a program of whose runs none is known. */
function useNever({ runs, open }: Pick<ProgramTableProps, "runs" | "open">): string {
  const { t } = useTranslation();
  if (!runs || !open) return "";
  return t(runs.length < NEWEST_RUNS ? "pages.programs.neverRan" : "pages.programs.notLately");
}

export function ProgramTable({ programs, runs, open, editable }: ProgramTableProps) {
  const { t } = useTranslation();
  const now = useNow();
  const last = lastRuns(joinRuns(runs ?? [], open ?? []), now);
  const never = useNever({ runs, open });
  return (
    <div className={styles.scroll}>
      <table className={styles.table}>
        <thead>
          <tr>
            {["name", "steps", "edited", "state", "lastRun"].map((column) => (
              <th key={column} scope="col" className={column === "steps" ? styles.optional : undefined}>
                {t(`pages.programs.column.${column}`)}
              </th>
            ))}
            {editable ? (
              <th scope="col">
                <span className="visually-hidden">{t("pages.more")}</span>
              </th>
            ) : null}
          </tr>
        </thead>
        <tbody>
          {programs.map((program) => (
            <Row
              key={program.id}
              program={program}
              run={last.get(program.id)}
              never={never}
              now={now}
              editable={editable}
            />
          ))}
        </tbody>
      </table>
    </div>
  );
}
