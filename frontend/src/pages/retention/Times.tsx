/** For how many days a site keeps each kind, with fields to choose others. */
import { TextInput } from "@mantine/core";
import { useTranslation } from "react-i18next";
import type { Retention, SetKeeping } from "@/api/types";
import { formatNumber } from "@/i18n/format";
import { MOST_DAYS } from "../settings/bounds";
import { SettingForm } from "../settings/SettingForm";
import { useSetSetting, useTouched } from "../settings/siteSetting";
import { PATH, readDays } from "./retention";

type Kind = Retention["keeping"][number]["kind"];
type Typed = Record<Kind, string>;

function typedOf(retention: Retention): Typed {
  const typed: Typed = { runs: "", rehearsals: "", calls: "" };
  for (const { kind, chosen } of retention.keeping) typed[kind] = chosen === null ? "" : String(chosen);
  return typed;
}

/** The days of the fields; null when one of them holds what is no number of days. */
function readAll(typed: Partial<Typed>): Partial<SetKeeping> | null {
  const days = Object.entries(typed).map(([kind, text]) => [kind, readDays(text)] as const);
  return days.some(([, each]) => each === undefined) ? null : Object.fromEntries(days);
}

export function Times({ slug, retention }: { slug: string; retention: Retention }) {
  const { t } = useTranslation();
  const save = useSetSetting<Retention, SetKeeping>({ slug, path: PATH, saved: t("retention.saved") });
  const { fields: typed, touched, touch, settle } = useTouched(typedOf(retention));
  const daysOf = (days: number) => (days === 0 ? t("retention.forEver") : t("retention.daysOf", { count: days }));
  const days = readAll(touched);
  const wrong = t("retention.wrong", { most: formatNumber(MOST_DAYS) });
  return (
    <SettingForm
      heading={t("retention.times")}
      intro={t("retention.intro")}
      foot={t("retention.asServer")}
      isSaving={save.isPending}
      isWrong={!days}
      onSave={() => days && save.mutate(days, { onSuccess: () => settle(touched) })}
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
          onChange={(event) => touch({ [kind]: event.currentTarget.value })}
        />
      ))}
    </SettingForm>
  );
}
