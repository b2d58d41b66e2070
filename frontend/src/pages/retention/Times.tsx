/** For how many days a site keeps each kind, with fields to choose others. */
import { TextInput } from "@mantine/core";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Retention, SetKeeping } from "@/api/types";
import { formatNumber } from "@/i18n/format";
import { MOST_DAYS } from "../settings/bounds";
import { SettingForm } from "../settings/SettingForm";
import { useSetSetting } from "../settings/siteSetting";
import { PATH, readDays } from "./retention";

type Kind = Retention["keeping"][number]["kind"];
type Typed = Record<Kind, string>;

function typedOf(retention: Retention): Typed {
  const typed: Typed = { runs: "", rehearsals: "", calls: "" };
  for (const { kind, chosen } of retention.keeping) typed[kind] = chosen === null ? "" : String(chosen);
  return typed;
}

export function Times({ slug, retention }: { slug: string; retention: Retention }) {
  const { t } = useTranslation();
  const save = useSetSetting<Retention, SetKeeping>({ slug, path: PATH, saved: t("retention.saved") });
  const [typed, setTyped] = useState(() => typedOf(retention));
  const daysOf = (days: number) => (days === 0 ? t("retention.forEver") : t("retention.daysOf", { count: days }));
  const [runs, rehearsals, calls] = [typed.runs, typed.rehearsals, typed.calls].map(readDays);
  const chosen =
    runs === undefined || rehearsals === undefined || calls === undefined ? null : { runs, rehearsals, calls };
  const wrong = t("retention.wrong", { most: formatNumber(MOST_DAYS) });
  return (
    <SettingForm
      heading={t("retention.times")}
      intro={t("retention.intro")}
      foot={t("retention.asServer")}
      isSaving={save.isPending}
      isWrong={!chosen}
      onSave={() => chosen && save.mutate(chosen)}
    >
      {retention.keeping.map(({ kind, server }) => (
        <TextInput
          key={kind}
          label={`${t(`retention.kind.${kind}`)}: ${t("retention.days")}`}
          description={t("retention.server", { days: daysOf(server) })}
          placeholder={String(server)}
          inputMode="numeric"
          value={typed[kind]}
          error={readDays(typed[kind]) === undefined ? wrong : null}
          onChange={(event) => setTyped({ ...typed, [kind]: event.currentTarget.value })}
        />
      ))}
    </SettingForm>
  );
}
