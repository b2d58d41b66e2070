/** A program for another site: who there stands for whom, proposed by what devices describe; the rest stays open. */
import { Button, Modal, NativeSelect, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { CircleCheck, TriangleAlert } from "lucide-react";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { api } from "@/api/client";
import { keys, useSites } from "@/api/queries";
import type { Program, PromotionBinding, PromotionLook, Site } from "@/api/types";
import { abilityWords } from "@/program/words/libraryWords";
import { LoadProblem, problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import pages from "../pages.module.css";
import { TableSkeleton } from "../TableSkeleton";
import { mayEdit } from "./NewProgram";
import styles from "./promote.module.css";

type Chosen = Readonly<Record<string, string | null>>;

export function PromoteProgram({ program, onClose }: { program: Program; onClose: () => void }) {
  const { t } = useTranslation();
  const sites = useSites().data?.filter((site) => site.slug !== program.site && mayEdit(site.role));
  const [asked, setAsked] = useState("");
  const site = sites?.find((each) => each.slug === asked) ?? sites?.[0];
  return (
    <Modal opened onClose={onClose} title={t("promote.title", { name: program.name })} size={620}>
      {!sites ? <TableSkeleton /> : null}
      {sites && !site ? <p>{t("promote.none")}</p> : null}
      {sites && site ? (
        <div className={pages.form}>
          <NativeSelect
            data-autofocus
            label={t("promote.site")}
            data={sites.map((each) => ({ value: each.slug, label: each.name }))}
            value={site.slug}
            onChange={(event) => setAsked(event.currentTarget.value)}
          />
          <Promotion key={site.slug} program={program} site={site} onClose={onClose} />
        </div>
      ) : null}
    </Modal>
  );
}

function Promotion({ program, site, onClose }: { program: Program; site: Site; onClose: () => void }) {
  const look = useQuery({
    queryKey: ["promotion", program.id, site.slug],
    queryFn: () => api.post<PromotionLook>(`/programs/${program.id}/promotion/look`, { site: site.slug }),
    gcTime: 0,
  });
  if (look.isPending) return <TableSkeleton />;
  if (look.isError) return <LoadProblem error={look.error} again={() => void look.refetch()} />;
  return <Bindings program={program} site={site} look={look.data} onClose={onClose} />;
}

interface BindingsProps {
  program: Program;
  site: Site;
  look: PromotionLook;
  onClose: () => void;
}

function Bindings({ program, site, look, onClose }: BindingsProps) {
  const { t } = useTranslation();
  const [name, setName] = useState(program.name);
  const [chosen, setChosen] = useState<Chosen>(() =>
    Object.fromEntries(look.bindings.map((binding) => [binding.id, binding.proposed])),
  );
  const promote = usePromote(program, site, onClose);
  const open = Object.values(chosen).filter((other) => other === null).length;
  const submit = (event: FormEvent) => {
    event.preventDefault();
    promote.mutate({ name: name.trim(), chosen });
  };
  return (
    <form onSubmit={submit} className={pages.form}>
      <TextInput
        label={t("promote.name")}
        maxLength={100}
        value={name}
        onChange={(event) => setName(event.currentTarget.value)}
      />
      {look.bindings.length > 0 ? (
        <fieldset className={styles.bindings}>
          <legend>{t("promote.bindings")}</legend>
          {look.bindings.map((binding) => (
            <Choice
              key={binding.id}
              binding={binding}
              chosen={chosen[binding.id] ?? null}
              onChoose={(other) => setChosen({ ...chosen, [binding.id]: other })}
            />
          ))}
        </fieldset>
      ) : null}
      <ul className={styles.notes}>
        <li>{open > 0 ? t("promote.open", { count: open }) : t("promote.allBound")}</li>
        {look.points > 0 ? <li>{t("promote.points", { count: look.points })}</li> : null}
        {look.zones > 0 ? <li>{t("promote.zones", { count: look.zones })}</li> : null}
      </ul>
      {promote.isError ? <p role="alert">{problemText(promote.error, t("shell.problem.screen"))}</p> : null}
      <Button type="submit" disabled={!name.trim()} loading={promote.isPending}>
        {t("promote.do", { site: site.name })}
      </Button>
    </form>
  );
}

interface ChoiceProps {
  binding: PromotionBinding;
  chosen: string | null;
  onChoose: (other: string | null) => void;
}

function Choice({ binding, chosen, onChoose }: ChoiceProps) {
  const { t } = useTranslation();
  const other = binding.candidates.find((each) => each.id === chosen);
  const fits = other?.fits ?? false;
  const wanted = binding.need ? abilityWords(t, binding.need) : "";
  const told = fits ? t("promote.fits") : t(other ? "promote.fitsNot" : "promote.hole");
  return (
    <div className={styles.choice}>
      <NativeSelect
        label={binding.name}
        description={wanted ? t("promote.wants", { list: wanted }) : undefined}
        data={[
          { value: "", label: t("promote.leaveOpen") },
          ...binding.candidates.map((each) => ({
            value: each.id,
            label: each.fits ? each.name : t("promote.unfit", { name: each.name }),
          })),
        ]}
        value={chosen ?? ""}
        onChange={(event) => onChoose(event.currentTarget.value || null)}
      />
      <span className={styles.sign} data-fits={fits}>
        {fits ? <CircleCheck size={15} aria-hidden="true" /> : <TriangleAlert size={15} aria-hidden="true" />}
        {told}
      </span>
    </div>
  );
}

function usePromote(program: Program, site: Site, onClose: () => void) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const navigate = useNavigate();
  return useMutation({
    mutationFn: (wanted: { name: string; chosen: Chosen }) =>
      api.post<Program>(`/programs/${program.id}/promotion`, { site: site.slug, ...wanted }),
    onSuccess: (made) => {
      notifications.show({ message: t("promote.done", { name: made.name, site: site.name }) });
      void queries.invalidateQueries({ queryKey: keys.programs(site.slug) });
      onClose();
      void navigate(`/programs/${made.id}`);
    },
    onError: useTellUnseen(),
  });
}
