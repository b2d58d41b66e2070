/** How one signs in: accounts elsewhere that are linked, linking one, and taking a link away. */
import { Button, Modal, PasswordInput } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Link2 } from "lucide-react";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { api, ApiProblem } from "@/api/client";
import type { OwnSignOn, SignOnProvider } from "@/api/types";
import { Panel } from "@/design/Panel";
import { useNow } from "@/design/useNow";
import { useReturnFocus } from "@/design/useReturnFocus";
import { formatAgo, formatMoment } from "@/i18n/format";
import { LoadProblem } from "@/shell/LoadProblem";
import pages from "../pages.module.css";
import { useProviders } from "../signin/providers";
import styles from "./account.module.css";
import { Told } from "./Told";
import { useWaysIn } from "./waysIn";

function LinkDialog({ to, asks, onClose }: { to: SignOnProvider; asks: boolean; onClose: () => void }) {
  const { t } = useTranslation();
  useReturnFocus();
  const [password, setPassword] = useState("");
  const begin = useMutation({
    mutationFn: () => api.post<{ address: string }>("/me/sign-ons", { provider: to.name, password }),
    onSuccess: ({ address }) => location.assign(address),
  });
  const refusedFor = begin.error instanceof ApiProblem ? begin.error.code : "";
  const submit = (event: FormEvent) => {
    event.preventDefault();
    begin.mutate();
  };
  return (
    <Modal opened onClose={onClose} title={t("signOn.linkTitle", { title: to.title })} size={460}>
      <form className={`${pages.form} ${styles.form}`} onSubmit={submit}>
        <p>{t("signOn.linkText", { title: to.title })}</p>
        {asks ? (
          <PasswordInput
            label={t("signOn.password")}
            autoComplete="current-password"
            required
            withAsterisk={false}
            data-autofocus
            value={password}
            error={refusedFor === "wrong_old_password"}
            onChange={(event) => setPassword(event.target.value)}
          />
        ) : (
          <p>{t("signOn.fresh")}</p>
        )}
        <Told error={begin.error} done="" />
        <div className={pages.buttons}>
          <Button variant="default" onClick={onClose}>
            {t("signOn.cancel")}
          </Button>
          <Button type="submit" loading={begin.isPending || begin.isSuccess} disabled={asks && !password}>
            {t("signOn.goOn")}
          </Button>
        </div>
      </form>
    </Modal>
  );
}

function UnlinkDialog({ signOn, onClose }: { signOn: OwnSignOn; onClose: () => void }) {
  const { t } = useTranslation();
  useReturnFocus();
  const queries = useQueryClient();
  const navigate = useNavigate();
  const { title } = signOn;
  const end = useMutation({
    mutationFn: () => api.delete(`/me/sign-ons/${signOn.id}`),
    onSuccess: async () => {
      await navigate("/sign-in");
      queries.clear();
    },
  });
  return (
    <Modal opened onClose={onClose} title={t("signOn.unlinkTitle", { title })} size={460}>
      <div className={`${pages.form} ${styles.form}`}>
        <p>{t("signOn.unlinkText", { title })}</p>
        <Told error={end.error} done="" />
        <div className={pages.buttons}>
          <Button variant="default" onClick={onClose} data-autofocus>
            {t("signOn.keep")}
          </Button>
          <Button color="red.9" loading={end.isPending} onClick={() => end.mutate()}>
            {t("signOn.unlink")}
          </Button>
        </div>
      </div>
    </Modal>
  );
}

function Linked({ signOn, onUnlink }: { signOn: OwnSignOn; onUnlink: () => void }) {
  const { t } = useTranslation();
  const now = useNow(30_000);
  const { title, label, linked_at: linked, used_at: used } = signOn;
  return (
    <li className={styles.session}>
      <div>
        <strong>{title}</strong>
        {label}
        <p>
          {t("signOn.linked", { when: formatMoment(linked) })}
          {", "}
          {used ? t("signOn.used", { ago: formatAgo(used, now) }) : t("signOn.unused")}
        </p>
      </div>
      <Button variant="default" size="xs" aria-label={t("signOn.unlinkNamed", { title })} onClick={onUnlink}>
        {t("signOn.unlink")}
      </Button>
    </li>
  );
}

/** Nothing where nobody signs in by a provider. */
export function WaysIn() {
  const { t } = useTranslation();
  const ways = useWaysIn();
  const providers = useProviders();
  const [linking, setLinking] = useState<SignOnProvider | null>(null);
  const [unlinking, setUnlinking] = useState<OwnSignOn | null>(null);
  if (ways.isLoadingError) return <LoadProblem error={ways.error} again={() => void ways.refetch()} />;
  if (!ways.data || !providers.data) return null;
  const { has_password: hasPassword, sign_ons: linked } = ways.data;
  const open = providers.data.filter(({ name }) => !linked.some(({ provider }) => provider === name));
  if (linked.length === 0 && open.length === 0 && hasPassword) return null;
  const text = !hasPassword ? "signOn.only" : linked.length > 0 ? "signOn.waysText" : "signOn.waysNone";
  return (
    <Panel className={styles.card} role="region" aria-labelledby="ways-in">
      <div className={styles.form}>
        <div>
          <h2 id="ways-in">{t("signOn.ways")}</h2>
          <p>{t(text)}</p>
        </div>
        {linked.length > 0 ? (
          <ul className={styles.sessions} aria-labelledby="ways-in">
            {linked.map((each) => (
              <Linked key={each.id} signOn={each} onUnlink={() => setUnlinking(each)} />
            ))}
          </ul>
        ) : null}
        {open.length > 0 ? (
          <div className={styles.row}>
            {open.map((each) => (
              <Button
                key={each.name}
                variant="default"
                leftSection={<Link2 size={16} aria-hidden="true" />}
                onClick={() => setLinking(each)}
              >
                {t("signOn.link", { title: each.title })}
              </Button>
            ))}
          </div>
        ) : null}
      </div>
      {linking ? <LinkDialog to={linking} asks={hasPassword} onClose={() => setLinking(null)} /> : null}
      {unlinking ? <UnlinkDialog signOn={unlinking} onClose={() => setUnlinking(null)} /> : null}
    </Panel>
  );
}
