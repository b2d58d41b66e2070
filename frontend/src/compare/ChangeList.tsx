/** The changes in reading order, each with its fields, old and new; what is only tidied, folded away. */
import { Button } from "@mantine/core";
import { ArrowLeft, ArrowRight, ChevronRight, RotateCcw, Undo2 } from "lucide-react";
import { useEffect, useMemo, useRef } from "react";
import { useTranslation } from "react-i18next";
import type { ChangeKind, Comparison, ConstructChange } from "@/api/types";
import { IconButton } from "@/design/IconButton";
import { VipoIcon } from "@/design/VipoIcon";
import styles from "./compare.module.css";
import { ChangeTile } from "./CompareMap";
import { type FieldLine, fieldLines } from "./fieldWords";
import { keyOf } from "./marks";
import { useConstructWords } from "./useConstructWords";
import type { Pictures } from "./usePictures";
import type { Restore } from "./useRestore";

const KINDS: readonly ChangeKind[] = ["added", "removed", "changed", "moved"];

interface ListProps {
  comparison: Comparison | undefined;
  /** Both sides are one version. */
  isOne?: boolean;
  pictures: Pictures;
  chosen: string | null;
  canEdit: boolean;
  restore: Restore | null;
  walk: (by: 1 | -1) => void;
  onChoose: (key: string) => void;
}

export function ChangeList(props: ListProps) {
  const { comparison, chosen, restore, walk } = props;
  const { t } = useTranslation();
  const found = comparison?.difference;
  const changes = found?.constructs ?? [];
  const at = changes.findIndex((each) => keyOf(each) === chosen);
  return (
    <aside className={styles.list} aria-label={t("compare.changes")}>
      <header className={styles.listHead}>
        <h2>{found ? t("compare.count", { count: changes.length }) : t("compare.changes")}</h2>
        {at >= 0 ? <small>{t("compare.of", { at: at + 1, count: changes.length })}</small> : null}
        <IconButton label={t("compare.before")} disabled={changes.length === 0} onClick={() => walk(-1)}>
          <ArrowLeft size={16} aria-hidden="true" />
        </IconButton>
        <IconButton label={t("compare.next")} disabled={changes.length === 0} onClick={() => walk(1)}>
          <ArrowRight size={16} aria-hidden="true" />
        </IconButton>
      </header>
      <Counts changes={changes} />
      <State comparison={comparison} isOne={props.isOne ?? false} />
      {comparison?.new.errors ? (
        <p className={styles.state} role="status">
          {t("compare.errors", { count: comparison.new.errors })}
        </p>
      ) : null}
      <ol className={styles.changes}>
        {changes.map((change) => (
          <Change key={keyOf(change)} change={change} {...props} />
        ))}
      </ol>
      {found && found.tidied.length > 0 ? <Tidied {...props} changes={found.tidied} /> : null}
      {found && found.same > 0 && changes.length > 0 ? (
        <p className={styles.same}>
          <ChangeTile kind="same" /> {t("compare.same_steps", { count: found.same })}
          <small>{t("compare.dimmed")}</small>
        </p>
      ) : null}
      <Foot restore={restore} readOnly={!props.canEdit} />
    </aside>
  );
}

function Counts({ changes }: { changes: readonly ConstructChange[] }) {
  const { t } = useTranslation();
  if (changes.length === 0) return null;
  return (
    <ul className={styles.counts}>
      {KINDS.map((kind) => {
        const count = changes.filter((each) => each.kind === kind).length;
        return count > 0 ? (
          <li key={kind}>
            <ChangeTile kind={kind} size={16} /> {t(`compare.number.${kind}`, { count })}
          </li>
        ) : null;
      })}
    </ul>
  );
}

/** What is to be said where there is nothing to list. */
function State({ comparison, isOne }: { comparison: Comparison | undefined; isOne: boolean }) {
  const { t } = useTranslation();
  if (!comparison) return null;
  const problem = (["old", "new"] as const).find((side) => comparison[side].problem);
  if (problem)
    return (
      <p className={styles.state} role="status">
        {t(`compare.problem.${comparison[problem].problem}`, { side: t(`compare.show.${problem}`) })}
      </p>
    );
  if ((comparison.difference?.constructs.length ?? 0) > 0) return null;
  return (
    <p className={styles.state} role="status">
      {isOne
        ? t("compare.one_version")
        : t(comparison.difference?.tidied.length ? "compare.only_tidying" : "compare.no_difference")}
    </p>
  );
}

function useFieldLines(change: ConstructChange, pictures: Pictures): FieldLine[] {
  const { t } = useTranslation();
  return useMemo(() => {
    const [old, next] = [pictures.old, pictures.new].map((side) => ({
      speaker: { document: side.document, surroundings: side.surroundings, t: side.t },
      numbers: side.compiled?.numbers ?? {},
    }));
    return old && next ? fieldLines(change, old, next, (key, values) => String(t(key, values ?? {}))) : [];
  }, [change, pictures.old, pictures.new, t]);
}

function Change({ change, pictures, chosen, restore, onChoose }: ListProps & { change: ConstructChange }) {
  const { t } = useTranslation();
  const words = useConstructWords(pictures)(change);
  const lines = useFieldLines(change, pictures);
  const isChosen = keyOf(change) === chosen;
  const row = useRef<HTMLLIElement>(null);
  useEffect(() => {
    if (isChosen) row.current?.scrollIntoView({ block: "nearest" });
  }, [isChosen]);
  return (
    <li ref={row} data-chosen={isChosen || undefined}>
      <button
        type="button"
        className={styles.change}
        aria-current={isChosen || undefined}
        onClick={() => onChoose(keyOf(change))}
      >
        <ChangeTile kind={change.kind} size={20} />
        {words.number ? <span className={styles.number}>{words.number}</span> : null}
        {words.icon ? <VipoIcon name={words.icon} size={15} /> : null}
        <span className={styles.title}>{words.title}</span>
        <small>
          {t(change.kind === "changed" && change.moved ? "compare.kind.changed_moved" : `compare.kind.${change.kind}`)}
        </small>
      </button>
      <Fields {...{ lines, change }} restore={isChosen ? restore : null} />
      {isChosen && restore ? (
        <Button
          variant="default"
          size="xs"
          className={styles.restore}
          loading={restore.busy}
          leftSection={<RotateCcw size={14} aria-hidden="true" />}
          onClick={() => restore.ask({ what: "construct", change })}
        >
          {t("compare.restore_this")}
        </Button>
      ) : null}
    </li>
  );
}

interface FieldsProps {
  lines: readonly FieldLine[];
  change: ConstructChange;
  restore: Restore | null;
}

function Fields({ lines, change, restore }: FieldsProps) {
  const { t } = useTranslation();
  if (lines.length === 0) return null;
  const alone = restore && change.kind === "changed" && lines.length > 1;
  return (
    <dl className={styles.fields}>
      {lines.map((line) => (
        <div key={line.key}>
          <dt>{line.label}</dt>
          <dd>
            <del>{line.old ?? t("compare.none")}</del>
            <ArrowRight size={12} role="img" aria-label={t("compare.becomes")} />
            <ins>{line.new ?? t(change.kind === "removed" ? "compare.kind.removed" : "compare.none")}</ins>
          </dd>
          {alone ? (
            <IconButton
              label={t("compare.restore_field", { field: line.label })}
              onClick={() => restore.ask({ what: "field", change, path: line.path })}
            >
              <RotateCcw size={13} aria-hidden="true" />
            </IconButton>
          ) : null}
        </div>
      ))}
    </dl>
  );
}

/** Chips moved, lines bent, comments renamed: open by itself only where there is nothing else. */
function Tidied({ changes, pictures }: ListProps & { changes: readonly ConstructChange[] }) {
  const { t } = useTranslation();
  const wordsOf = useConstructWords(pictures);
  return (
    <details className={styles.tidied}>
      <summary>
        <ChevronRight size={14} aria-hidden="true" />
        <b>{t("compare.tidying", { count: changes.length })}</b>
        <small>{t("compare.does_the_same")}</small>
      </summary>
      <ul>
        {changes.map((change) => {
          const words = wordsOf(change);
          return (
            <li key={keyOf(change)}>
              {words.number ? <span className={styles.number}>{words.number}</span> : null}
              {words.title}
            </li>
          );
        })}
      </ul>
    </details>
  );
}

function Foot({ restore, readOnly }: { restore: Restore | null; readOnly: boolean }) {
  const { t } = useTranslation();
  return (
    <footer className={styles.foot}>
      {restore?.canUndo ? (
        <Button
          variant="default"
          size="xs"
          loading={restore.busy}
          leftSection={<Undo2 size={14} aria-hidden="true" />}
          onClick={restore.undo}
        >
          {t("compare.undo")}
        </Button>
      ) : null}
      <p>
        <kbd>←</kbd> <kbd>→</kbd> {t("compare.key.walk")} <kbd>Enter</kbd> {t("compare.key.show")}
        {restore ? (
          <>
            {" "}
            <kbd>R</kbd> {t("compare.key.restore")}
          </>
        ) : null}
      </p>
      {readOnly ? <p>{t("compare.read_only")}</p> : null}
    </footer>
  );
}
