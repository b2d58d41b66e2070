/** For how many days a site keeps each kind, with fields to choose others. */
import { Button, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { type FormEvent, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Retention } from "@/api/types";
import { Panel } from "@/design/Panel";
import { problemText } from "@/shell/LoadProblem";
import { readDays, useSetKeeping } from "./retention";
import styles from "./retention.module.css";

type Kind = Retention["keeping"][number]["kind"];
type Typed = Record<Kind, string>;

function typedOf(retention: Retention): Typed {
  const typed: Typed = { runs: "", rehearsals: "", calls: "" };
  for (const { kind, chosen } of retention.keeping) typed[kind] = chosen === null ? "" : String(chosen);
  return typed;
}

export function Times({ slug, retention }: { slug: string; retention: Retention }) {
  const { t } = useTranslation();
  const save = useSetKeeping(slug);
  const [typed, setTyped] = useState(() => typedOf(retention));
  const daysOf = (days: number) => (days === 0 ? t("retention.forEver") : t("retention.daysOf", { count: days }));
  const isWrong = Object.values(typed).some((each) => readDays(each) === undefined);
  const onSubmit = (event: FormEvent) => {
    event.preventDefault();
    const [runs, rehearsals, calls] = [typed.runs, typed.rehearsals, typed.calls].map(readDays);
    if (runs === undefined || rehearsals === undefined || calls === undefined) return;
    save.mutate(
      { runs, rehearsals, calls },
      {
        onSuccess: () => notifications.show({ message: t("retention.saved") }),
        onError: (error) =>
          notifications.show({ color: "red", message: problemText(error, t("shell.problem.screen")) }),
      },
    );
  };
  return (
    <Panel className={styles.times} aria-label={t("retention.times")}>
      <h2>{t("retention.times")}</h2>
      <p>{t("retention.intro")}</p>
      <form onSubmit={onSubmit} className={styles.fields}>
        {retention.keeping.map(({ kind, server }) => (
          <TextInput
            key={kind}
            label={`${t(`retention.kind.${kind}`)}: ${t("retention.days")}`}
            description={t("retention.server", { days: daysOf(server) })}
            placeholder={String(server)}
            inputMode="numeric"
            value={typed[kind]}
            error={readDays(typed[kind]) === undefined ? t("retention.wrong") : null}
            onChange={(event) => setTyped({ ...typed, [kind]: event.currentTarget.value })}
          />
        ))}
        <Button type="submit" className={styles.save} loading={save.isPending} disabled={isWrong}>
          {t("retention.save")}
        </Button>
      </form>
      <p>{t("retention.asServer")}</p>
    </Panel>
  );
}
